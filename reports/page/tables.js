// SPDX-License-Identifier: GPL-3.0-or-later
// Cards and tables of the present selection.

// ---- cards and tables --------------------------------------------------------------------------------

// A card with its list; returns line(name, value, small, id).
function card(parent, name, corner) {
  const node = element(parent, "article", undefined, { class: "card", "data-variant": name });
  node.style.setProperty("--colour", colour(indexOf(name)));
  element(element(node, "h3", name), "small", corner);
  const list = element(node, "dl");
  return function (title, value, small, id) {
    element(list, "dt", title);
    const dd = element(list, "dd", value, id ? { "data-figure": id } : {});
    if (small) element(dd, "small", small);
  };
}

function variantCard(parent, v) {
  const r = v.frontal_crashes_per_million_km, olc = v.olc_g[state.scope], line = card(parent, v.variant, `${v.replications} replications`);
  line("Exposure, vehicle-km", integer(Math.round(v.vehicle_km)));
  line("Frontal crashes", integer(v.frontal_crashes), undefined, "frontal_crashes");
  line("of these front-front inside range", integer(v.front_front_inside), undefined, "front_front_inside");
  line("Rate per 10⁶ veh-km", rate(r.value), r.interval.status === "value" ? `95 % ${interval(r.interval, rate)}${r.bootstrap.status === "value" ? "" : " (Poisson, widened)"}` : undefined);
  const above = v.crashes_above.olc;
  line(`Above ${above.x} g per 10⁶ veh-km`, rate(above.per_million_km), `${crashes(above.crashes)}; ${interval(above.interval, rate)}`);
  line("Vehicles struck on the front", integer(v.frontal_vehicles), `${percent(v.share_inside_validity)} inside validated range`, "frontal_vehicles");
  line("Median OLC, g", estimate(olc.median, 1), `n = ${olc.n}${olc.censored ? `, ${olc.censored} censored` : ""}`, "median");
}

// A treatment of the counterfactual design has no replications: what became of the baseline's crashes.
function treatmentCard(parent, c) {
  const line = card(parent, c.variant, `${integer(c.valid)} valid pairs`), olc = c.olc_change_g.all_pairs, share = name => `${percent(c.valid ? c.outcomes[name] / c.valid : null)}; 95 % ${interval(c.shares[name], percent)}`;
  ["avoided", "mitigated", "unchanged", "aggravated", "changed_opponent"].forEach(name => line(readable(name).replace(/^./, l => l.toUpperCase()), integer(c.outcomes[name]), name === "unchanged" || c.outcomes[name] === 0 ? undefined : share(name), name));
  line("New crashes between others", integer(c.new_crashes));
  line("Change of OLC, g", fixed(olc.hodges_lehmann, 1), interval(olc.hodges_lehmann_interval, n => fixed(n, 1)));
}

function cards() {
  const parent = document.getElementById("cards");
  parent.textContent = "";
  shownVariants().forEach(v => variantCard(parent, v));
  shownPairs().forEach(c => treatmentCard(parent, c));
  const filtered = state.scenario !== "" || state.crashType !== "";
  document.getElementById("slice-answer").textContent = filtered ? slice().answer : "";
  const total = d3.sum(shownVariants(), v => v.frontal_crashes);
  document.getElementById("status").textContent = `${crashes(total, "frontal")} selected`;
}

// A table section with its CSV button and SQL.
function tableSection(id, query, content) {
  const tools = document.getElementById(`tools-${id}`);
  const button = element(tools, "button", "CSV", { type: "button", "aria-label": `Table ${id} as CSV` });
  button.onclick = () => { const c = content(); download(fileName(id, "csv"), "text/csv", csv(c.columns.map(column => column.name), c.rows)); };
  if (query) sqlDetails(tools, query);
  return function () {
    const parent = document.getElementById(`table-${id}`), c = content();
    parent.textContent = "";
    table(parent, c.caption || "", c.columns, c.rows);
  };
}

const quantileTable = tableSection("quantiles", "olc_quantiles", function () {
  const rows = [];
  shownVariants().forEach(v => ["all", "inside"].forEach(scope => {
    const d = v.olc_g[scope];
    rows.push([v.variant, scope === "all" ? "all" : "inside range", d.n, d.censored, estimate(d.mean, 1), fixed(d.sd, 1),
      ...[d.min, d.q25, d.median, d.q75, d.p90, d.p95, d.max].map(e => estimate(e, 1))]);
  }));
  return {
    columns: [{ name: "variant", text: true }, { name: "vehicles", text: true }, ...["n", "censored", "mean", "sd", "min", "25 %", "median", "75 %", "90 %", "95 %", "max"].map(name => ({ name: name }))],
    rows: rows
  };
});

const contrastTable = tableSection("contrasts", "", function () {
  const rows = [];
  const two = value => fixed(value, 2), one = value => fixed(value, 1);
  const bounds = (low, high, format) => `${missing(low) ? "−∞" : format(low)} to ${missing(high) ? "∞" : format(high)}`;
  shownContrasts().forEach(c => {
    const o = c.olc_g, speed = c.closing_speed_m_s, dv = c.delta_v_m_s, km_h = n => fixed(3.6 * n, 1);
    const add = (what, value, i, bound, p, holm) => rows.push([c.variant, what, value, i, bound, p, holm]);
    const test = q => missing(q.superiority.p) ? q.superiority.status : (q.superiority.status === "value" ? "" : "≤ ") + pValue(q.superiority.p);
    const change = e => missing(e) ? "–" : (e.relation === "=" ? "" : `${e.relation} `) + km_h(e.value);
    add("rate ratio of frontal crashes", ratio(c.rate_ratio), interval(c.rate_ratio_interval, ratio), "", pValue(c.rate_p), pValue(c.rate_p_holm));
    [["olc", 1, "g OLC"], ["delta_v", 3.6, "km/h delta-v"]].forEach(([key, factor, unit]) => {
      const r = c.crashes_above[key];
      add(`rate ratio of crashes above ${Number((factor * r.x).toPrecision(6))} ${unit} (${r.crashes[1]} against ${r.crashes[0]})`, ratio(r.ratio), interval(r.interval, ratio), bounds(r.bound_intervals[0].low, r.bound_intervals[1].high, ratio), "", "");
    });
    add(`Cliff’s δ of OLC (${o.compared[1]} against ${o.compared[0]} vehicles)`, fixed(o.superiority.cliffs_delta, 2), interval(o.superiority.interval, two), c.olc_bounds.every(b => b.status === "value") ? bounds(c.olc_bounds[0].interval.low, c.olc_bounds[1].interval.high, two) : "–", test(o), pValue(o.p_holm));
    add(`difference in median OLC, g (${estimate(o.medians[1], 1)} against ${estimate(o.medians[0], 1)})`, estimate(o.median_difference, 1), interval(o.median_interval, one), "", "", "");
    add("difference in mean OLC, g", estimate(o.mean_difference, 1), interval(o.mean_interval, one), "", "", "");
    add("difference in 90 % OLC, g", estimate(o.p90_difference, 1), interval(o.p90_interval, one), "", "", "");
    add("largest distance of the distributions of OLC", fixed(o.distance, 2), "", "", missing(o.distance_p) ? "too few" : pValue(o.distance_p), pValue(o.distance_p_holm));
    add("difference in median delta-v, km/h", change(dv.median_difference), interval(dv.median_interval, km_h), "", test(dv), pValue(dv.p_holm));
    add("difference in median closing speed, km/h", change(speed.median_difference), interval(speed.median_interval, km_h), "", test(speed), pValue(speed.p_holm));
  });
  // Crash by crash in the counterfactual design.
  shownPairs().forEach(c => {
    [["all_pairs", "avoided = 0"], ["conditional_on_crashing", "conditional on crashing"]].forEach(([key, which]) => {
      const add = (what, value, i, p, holm) => rows.push([c.variant, `${what}, ${which}`, value, i, "", p, holm]);
      const o = c.olc_change_g[key], v = c.closing_speed_change_m_s[key], km_h = n => fixed(3.6 * n, 1);
      add("change of OLC, g (Hodges–Lehmann, signed rank)", one(o.hodges_lehmann), interval(o.hodges_lehmann_interval, one), pValue(o.signed_rank_p), pValue(o.signed_rank_p_holm));
      add("mean change of OLC, g", one(o.mean), interval(o.mean_interval, one), "", "");
      add("change of closing speed, km/h (Hodges–Lehmann, signed rank)", missing(v.hodges_lehmann) ? "–" : km_h(v.hodges_lehmann), interval(v.hodges_lehmann_interval, km_h), pValue(v.signed_rank_p), pValue(v.signed_rank_p_holm));
    });
  });
  // Pairs have no rates: no column of theirs.
  const paired = slice().counterfactual.length > 0, without = list => paired ? list.filter((v, k) => k !== 4) : list;
  return {
    caption: paired ? "Within pairs, over all valid ones." : "Over all frontally struck vehicles, scenarios mixed alike.",
    columns: without([{ name: "treatment", text: true }, { name: "treatment minus (over) baseline", text: true }, { name: "estimate" }, { name: "95 % interval" }, { name: "95 %, unknown outside" }, { name: "p" }, { name: "p, Holm" }]),
    rows: rows.map(without)
  };
});

// The scorecard that ships with the program: a line a class, a column a vehicle.
const scorecard = d3.csvParse(document.getElementById("scorecard").textContent.trim());
const scorecardTable = tableSection("scorecard", null, function () {
  const vehicles = Array.from(new Set(scorecard.map(row => row.vehicle)));
  const off = row => {
    const figure = row.bar.startsWith("largest") ? row.max_abs : row.mean_abs;
    if (figure !== "") return `${row.label} ${+figure} ${row.error_unit === "1" ? "" : row.error_unit}`.trim();
    return `${row.label}, ${row.note ? row.note.split(",")[0] : `${+row.model} ${row.unit}`}`;
  };
  const verdict = rows => {
    const judged = rows.filter(row => row.result === "kept" || row.result === "missed"), missed = judged.filter(row => row.result === "missed");
    const compared = rows.filter(row => row.result === "no bar");
    if (!judged.length) return compared.length ? `no bar; off by: ${compared.map(off).join("; ")}` : "–";
    return `${judged.length - missed.length} of ${judged.length}${missed.length ? "; missed: " + missed.map(off).join("; ") : ""}`;
  };
  return {
    columns: [{ name: "crash tests", text: true }, ...vehicles.map(name => ({ name: name, text: true }))],
    rows: Array.from(d3.group(scorecard, row => row.title), ([title, rows]) => [title, ...vehicles.map(name => verdict(rows.filter(row => row.vehicle === name)))])
  };
});

// Which tests speak for the severities: frontal vehicles of each variant by the class around them.
const evidenceTable = tableSection("evidence", "validity_classes", function () {
  const total = d3.rollup(data.about.evidence, rows => d3.sum(rows, row => row.vehicles), row => row.variant);
  return {
    caption: "Frontally struck vehicles of the whole study. Errors are those of the class, common to all of its crashes; none: outside, its error unknown.",
    columns: [{ name: "variant", text: true }, { name: "class of tests", text: true }, { name: "vehicles" }, { name: "share" }, { name: "error of severity" }, { name: "of OLC, g" }],
    rows: data.about.evidence.map(row => [row.variant, readable(row.evidence_class), integer(row.vehicles), percent(row.vehicles / total.get(row.variant)),
      missing(row.error_1) ? "–" : percent(row.error_1), missing(row.error_g) ? "–" : fixed(row.error_g, 1)])
  };
});

const validityTable = tableSection("validity", "validity", function () {
  const counts = new Map();
  d3.range(data.validity_counts.length).forEach(k => {
    const c = data.validity_counts[k];
    if ((state.scenario !== "" && data.scenarios[c.scenario] !== state.scenario) || (state.crashType !== "" && data.crash_types[c.crash_type] !== state.crashType)) return;
    const row = counts.get(c.validity) || data.variants.map(() => 0);
    row[c.variant] += c.vehicles;
    counts.set(c.validity, row);
  });
  const totals = data.variants.map((v, k) => d3.sum(Array.from(counts.values()), row => row[k]));
  const rows = Array.from(counts.entries()).sort((a, b) => (a[0] !== 0) - (b[0] !== 0) || d3.sum(b[1]) - d3.sum(a[1]))
    .map(([validity, row]) => [validity === 0 ? "inside" : `outside: ${readable(data.validity[validity])}`, ...d3.merge(row.map((n, k) => [n, totals[k] ? percent(n / totals[k]) : "–"]))]);
  rows.push(["all frontally struck vehicles", ...d3.merge(totals.map(n => [n, n ? "100 %" : "–"]))]);
  return { columns: [{ name: "validity", text: true }, ...d3.merge(data.variants.map(v => [{ name: v.name }, { name: "share" }]))], rows: rows };
});

const injuryTable = tableSection("injuries", "expected_injuries", function () {
  const rows = [];
  shownVariants().forEach(v => v.expected_injured_drivers[state.scope].forEach(i => {
    const risk = data.risks.find(r => r.name === i.function && r.level === i.level);
    rows.push([v.variant, i.level, i.function, i.drivers, i.unknown, fixed(i.expected, 2), rate(i.per_million_km), interval(i.interval, rate), `${risk.source}; ${risk.note}`]);
  }));
  return {
    columns: [{ name: "variant", text: true }, { name: "level", text: true }, { name: "function", text: true }, { name: "drivers" }, { name: "unknown" }, { name: "expected injured" }, { name: "per 10⁶ veh-km" }, { name: "95 % bootstrap" }, { name: "source", text: true }],
    rows: rows
  };
});

const precisionTable = tableSection("precision", "", function () {
  const rows = [], line = (name, what, p, replications) => rows.push([name, what, replications, percent(p.relative_1), integer(p.replications_for_10_percent)]);
  shownVariants().forEach(v => {
    line(v.variant, "frontal crash rate", v.frontal_crashes_per_million_km.precision, v.replications);
    line(v.variant, "mean OLC", v.olc_g[state.scope].mean_precision, v.replications);
  });
  shownContrasts().forEach(c => line(c.variant, "rate ratio", c.rate_ratio_precision, c.treatment_replications));
  return { columns: [{ name: "variant", text: true }, { name: "figure", text: true }, { name: "replications" }, { name: "half-width reached" }, { name: "replications in all for ±10 %" }], rows: rows };
});

const exposureTable = tableSection("exposure", "exposure_and_rates", function () {
  const rows = [];
  data.scenarios.forEach(name => data.slices.filter(s => s.scenario === name && s.crash_type === null).forEach(s => s.variants.forEach(v =>
    state.variants.has(indexOf(v.variant)) && rows.push([name, v.variant, v.replications, fixed(v.vehicle_km, 1), fixed(v.vehicle_h, 1), v.crashes, v.frontal_crashes, rate(v.frontal_crashes_per_million_km.value), fixed(v.frontal_crashes_per_million_km.widening.dispersion, 2)]))));
  return {
    columns: [{ name: "scenario", text: true }, { name: "variant", text: true }, ...["replications", "vehicle-km", "vehicle-h", "crashes", "frontal", "frontal per 10⁶ km", "dispersion"].map(name => ({ name: name }))],
    rows: rows
  };
});
