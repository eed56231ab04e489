# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Chromium driven by chromedriver on the loopback interface, with the standard library.

with Browser() as browser: browser.open(url); browser.run("return document.title")
"""
import base64
import json
import re
import shutil
import signal
import subprocess
import tempfile
import urllib.error
import urllib.request


class Browser:
    FLAGS = [
        "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
        "--disable-background-networking", "--disable-component-update", "--disable-sync",
        "--disable-default-apps", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
    ]

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="crashpulse-browser-")
        # Port 0: chromedriver takes a free one and says which.
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True,
                                       start_new_session=True)
        port = None
        for line in self.driver.stdout:
            found = re.search(r"on port (\d+)", line)
            if found and "successfully" in line:
                port = found.group(1)
                break
        if port is None:
            raise RuntimeError("chromedriver did not start")
        self.base = f"http://127.0.0.1:{port}"
        self.base += "/session/" + self._start()
        return self

    def _start(self):
        options = {"args": self.FLAGS + [f"--user-data-dir={self.profile}"]}
        answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
            "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        }}})
        return answer["sessionId"]

    def __exit__(self, *_):
        try:
            self._call("DELETE", "")
        finally:
            self.driver.send_signal(signal.SIGTERM)
            self.driver.wait()
            self.driver.stdout.close()
            shutil.rmtree(self.profile, ignore_errors=True)

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data=data, method=method,
                                         headers={"Content-Type": "application/json"})
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as failure:
            raise RuntimeError(failure.read().decode()) from None

    def open(self, url):
        self._call("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """Run JavaScript in the page; its return value."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def resize(self, width, height):
        """Size of the page itself, whatever the window's frame."""
        self._call("POST", "/goog/cdp/execute", {
            "cmd": "Emulation.setDeviceMetricsOverride",
            "params": {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}})

    def press(self, *keys):
        """Keys one after the other, as a user would: "Tab", "Enter", "Space", "ArrowDown" or a letter."""
        code = {"Tab": "\ue004", "Enter": "\ue007", "Space": " ", "ArrowDown": "\ue015"}
        strokes = [{"type": kind, "value": code.get(key, key)} for key in keys for kind in ("keyDown", "keyUp")]
        self._call("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": strokes}]})

    def media(self, kind):
        """Show the page as on "screen" or in "print"."""
        self._call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {"media": kind}})

    def pdf(self):
        """The page as printed on A4."""
        return base64.b64decode(self._call("POST", "/print", {"page": {"width": 21.0, "height": 29.7}}))

    def settle(self):
        """Return after the page has drawn: two animation frames later."""
        self._call("POST", "/execute/async", {"args": [], "script":
                   "const done = arguments[0];"
                   "requestAnimationFrame(() => requestAnimationFrame(() => done()));"})

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self._call("GET", "/screenshot")))

    def log(self, kind):
        """Entries since the last call: "browser" (console) or "performance" (network)."""
        return self._call("POST", "/se/log", {"type": kind})
