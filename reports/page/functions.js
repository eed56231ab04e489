// SPDX-License-Identifier: GPL-3.0-or-later
// How often functions act, over the whole study: no filter changes it.

// ---- activations --------------------------------------------------------------------------------

function activations() {
  if (data.activations.length === 0) { document.getElementById("section-functions").remove(); return; }
  const limits = (low, high) => missing(low) ? "–" : `${rate(low)} to ${missing(high) ? "∞" : rate(high)}`;
  table(document.getElementById("table-functions"),
    "Per 1000 hours of all vehicles on the road, equipped or not, with 95 % intervals that allow for what replications scatter.",
    [...["scenario", "driver errors", "variant", "function"].map(name => ({ name: name, text: true })),
      ...["vehicle-h", "activations", "per 1000 h", "95 %", "without a driver error", "per 1000 h", "95 %"].map(name => ({ name: name }))],
    data.activations.map(r => [r.scenario, r.has_errors ? "yes" : "none", r.variant, r.function, fixed(r.vehicle_h, 1), String(r.activations),
      rate(r.per_1000_h), limits(r.low, r.high), missing(r.without_error) ? "–" : String(r.without_error),
      rate(r.without_error_per_1000_h), limits(r.without_error_low, r.without_error_high)]));
}
