// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
// How often functions act: a table of its own, from data of its own. Needs nothing of the other script.
(function () {
  const rows = JSON.parse(document.getElementById("activations").textContent), section = document.getElementById("section-functions");
  if (!rows.length) { section.remove(); return; }
  const rate = value => value === null ? "–" : value >= 1000 ? Math.round(Number(value.toPrecision(3))).toLocaleString("en").replace(/,/g, " ") : String(Number(value.toPrecision(3)));
  const interval = (low, high) => low === null ? "–" : `${rate(low)} to ${high === null ? "∞" : rate(high)}`;
  const add = (parent, tag, text, className) => {
    const made = parent.appendChild(document.createElement(tag));
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  };
  const table = add(document.getElementById("table-functions"), "table"), head = add(add(table, "thead"), "tr"), body = add(table, "tbody");
  add(table, "caption", "Per 1000 hours of all vehicles on the road, equipped or not, with 95 % intervals that allow for what replications scatter.");
  [["scenario", "text"], ["driver errors", "text"], ["variant", "text"], ["function", "text"], ["vehicle-h"], ["activations"], ["per 1000 h"], ["95 %"], ["without a driver error"], ["per 1000 h"], ["95 %"]]
    .forEach(([name, className]) => { add(head, "th", name, className).scope = "col"; });
  rows.forEach(r => {
    const line = add(body, "tr");
    add(line, "th", r.scenario, "text").scope = "row";
    [r.has_errors ? "yes" : "none", r.variant, r.function].forEach(text => add(line, "td", text, "text"));
    [r.vehicle_h.toFixed(1), String(r.activations), rate(r.per_1000_h), interval(r.low, r.high), r.without_error === null ? "–" : String(r.without_error), rate(r.without_error_per_1000_h), interval(r.without_error_low, r.without_error_high)]
      .forEach(text => add(line, "td", text));
  });
})();
