# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm cluster of one node, its own: munged, slurmctld and slurmd with configuration, key, state
and ports of this test, started without systemd and stopped by their process ids."""
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "sinfo", "squeue")


def missing():
    """Why there can be no cluster here; None when there can."""
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    absent = [name for name in PROGRAMS if not shutil.which(name, path=path)]
    if absent:
        return f"not installed: {', '.join(absent)} (slurm-wlm, munge)"
    if os.geteuid() != 0:
        return "the daemons need root"
    return None


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"),
                                PATH=os.environ["PATH"] + ":/usr/sbin:/sbin")

    def start(self, words, name, user=None):
        log = open(self.folder / f"{name}.log", "w")
        self.daemons.append(subprocess.Popen(words, stdout=log, stderr=log, user=user,
                                             env=self.environment, start_new_session=True))

    def wait(self, what, condition):
        for _ in range(600):
            if condition():
                return
            dead = [d.args[0] for d in self.daemons if d.poll() is not None]
            if dead:
                break
            time.sleep(0.1)
        logs = "".join(f"--- {log.name}\n{log.read_text()[-2000:]}"
                       for log in self.folder.glob("*.log"))
        raise RuntimeError(f"waited in vain for {what}\n{logs}")

    def __enter__(self):
        try:
            self.begin()
        except BaseException:
            self.__exit__()
            raise
        return self

    def begin(self):
        munge = pwd.getpwnam("munge")
        secret = self.folder / "munge"
        secret.mkdir()
        key = secret / "munge.key"
        key.write_bytes(os.urandom(1024))
        for path in (key, secret):
            os.chown(path, munge.pw_uid, munge.pw_gid)
        key.chmod(0o400)
        secret.chmod(0o755)
        self.folder.chmod(0o755)
        self.start(["munged", "--foreground", f"--key-file={key}", f"--socket={secret}/socket",
                    f"--pid-file={secret}/pid", f"--log-file={secret}/munged.log",
                    f"--seed-file={secret}/seed"], "munged", user="munge")
        self.wait("munged", lambda: (secret / "socket").exists())

        node = socket.gethostname().split(".")[0]
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(f"""ClusterName=test
SlurmctldHost={node}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={secret}/socket
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName={node} NodeAddr=127.0.0.1 CPUs=2
PartitionName=test Nodes={node} Default=YES MaxTime=INFINITE State=UP
""")
        self.start(["slurmctld", "-D"], "slurmctld")
        self.start(["slurmd", "-D"], "slurmd")
        self.wait("an idle node", lambda: "idle" in self.run("sinfo", "-h", "-o", "%T",
                                                             check=False).stdout)

    def run(self, *words, check=True):
        return subprocess.run(words, env=self.environment, check=check, capture_output=True,
                              text=True)

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
