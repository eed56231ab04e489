// SPDX-License-Identifier: GPL-3.0-or-later
// How severely: distributions of OLC and delta-v, crashes above a severity, differences, pairs, OLC against closing speed.

// ---- distributions of OLC and delta-v -------------------------------------------------------------

// In the counterfactual design all variants are drawn over the same crashes: those judged with every
// treatment. Null in the other designs.
const judged = () => (slice().judged ? slice().judged[state.scope] : null);
const judgedVariants = () => judged().variants.filter(v => state.variants.has(indexOf(v.variant)));
const judgedText = () => `over the ${integer(judged().crashes)} frontal crashes${state.scope === "all" ? "" : " with both vehicles inside the validated range with the baseline"} that were judged with every treatment${judged().left_out ? ` (${integer(judged().left_out)} were not)` : ""}; the larger of the frontally struck vehicles of a crash, an avoided one below every value`;

// Steps of every chosen variant, and the half width of its band where there is one. what: "olc" or "delta_v".
function distributions(what) {
  const curve = (name, e, half) => ({ variant: indexOf(name), name: name, n: e.n, censored: e.censored, x: e.x, share: e.share, first: e.n ? e.censored / e.n : 0, half: missing(half) ? null : half });
  const list = judged() ? judgedVariants().map(v => Object.assign(curve(v.variant, v[what].ecdf, v[what].ecdf_band_half_width_1), { avoided: v.avoided }))
    : shownVariants().map(v => what === "olc" ? curve(v.variant, v.ecdf[state.scope], v.olc_g[state.scope].ecdf_band_half_width_1) : curve(v.variant, v.ecdf_delta_v_km_h[state.scope], null));
  return list.filter(d => d.n > 0);
}

const shareAt = (c, x) => { const k = d3.bisectRight(c.x, x); return k ? c.share[k - 1] : c.first; };

// "n = 73, 27 avoided, 6 censored"; what is avoided is among the values below every other.
function countText(c) {
  const censored = c.censored - (c.avoided || 0);
  return `n = ${c.n}${c.avoided ? `, ${c.avoided} avoided` : ""}${censored > 0 ? `, ${censored} censored` : ""}`;
}

// What lies under the study's curves of delta-v: functions of nothing that return {label, x (km/h), share, first},
// or null where they have nothing for the present selection.
const UNDER_DELTA_V = [];
const under = what => (what === "delta_v" ? UNDER_DELTA_V.map(f => f()).filter(Boolean) : []);

const stairs = (c, last) => [[0, c.first], ...c.x.map((value, k) => [value, c.share[k]]), [last, d3.max(c.share) || c.first]];

function drawDistributions(svg, width, what, xTitle, unit) {
  const curves = distributions(what), below = under(what), all = curves.concat(below);
  const lines = (g, v) => v === null ? g.append("line").attr("x2", 18).style("stroke", "var(--soft)").style("stroke-width", 5).style("opacity", 0.5) : lineMark(g, v);
  const top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: `${c.name} (${countText(c)})` })).concat(below.map(c => ({ variant: null, label: c.label }))), lines);
  const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
  const x = d3.scaleLinear().domain([0, d3.max(all, c => d3.max(c.x)) || 1]).nice().range([0, width - margin.left - margin.right]);
  const y = d3.scaleLinear().domain([0, 1]).range([height - margin.top - margin.bottom, 0]);
  const inner = frame(svg, width, height, margin, x, y, xTitle, judged() ? "share of crashes" : "share of vehicles");
  inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0.5)).attr("y2", y(0.5)).style("stroke", "var(--soft)").style("stroke-dasharray", "2 4");
  const path = c => d3.line().x(p => x(p[0])).y(p => y(p[1])).curve(d3.curveStepAfter)(stairs(c, x.domain()[1]));
  below.forEach(c => inner.append("path").attr("class", "under").attr("d", path(c)).style("fill", "none").style("stroke", "var(--soft)").style("stroke-width", 5).style("opacity", 0.5));
  curves.filter(c => c.half !== null).forEach(c => inner.append("path").attr("class", "band")
    .attr("d", d3.area().x(p => x(p[0])).y0(p => y(Math.max(0, p[1] - c.half))).y1(p => y(Math.min(1, p[1] + c.half))).curve(d3.curveStepAfter)(stairs(c, x.domain()[1])))
    .style("fill", colour(c.variant)).style("opacity", 0.14));
  curves.forEach(c => {
    inner.append("path").attr("class", "curve").attr("d", path(c)).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]);
    if (c.censored) inner.append("path").attr("d", symbol(c.variant, 60)).attr("transform", `translate(0,${y(c.first)})`).style("fill", colour(c.variant));
  });
  readout(svg, inner, x, y.range()[0], value => [`${fixed(value, 1)} ${unit}`, ...all.map(c => `${c.name || c.label}: ${percent(shareAt(c, value))}`)]);
  return height;
}

function distributionContent(what, column) {
  // Of what lies under them some eight points.
  const some = c => c.x.map((value, k) => k).filter(k => k % Math.ceil(c.x.length / 8) === 0 || k === c.x.length - 1);
  const rows = d3.merge(under(what).map(c => some(c).map(k => [c.label, c.x[k], c.share[k], null, null])));
  distributions(what).forEach(c => {
    const add = (value, share) => rows.push([c.name, value, share, c.half === null ? null : Math.max(0, share - c.half), c.half === null ? null : Math.min(1, share + c.half)]);
    if (c.censored) add(null, c.first);
    c.x.forEach((value, k) => add(value, c.share[k]));
  });
  return { summary: distributions(what).map(c => `${c.name}: ${c.n} ${judged() ? "crashes" : "vehicles"}, ${countText(c).split(", ").slice(1).join(", ") || "none censored"}`).join("; "), columns: ["variant", column, "share", "band_low", "band_high"], rows: rows };
}

const bandText = what => (distributions(what).some(c => c.half !== null) ? "; band: 95 % for the whole curve at once, by bootstrap over replications" : what === "olc" ? "; too few replications for a band" : "");

// Of pairs, the query of pairs has every value that is drawn.
if (data.slices[0].judged) ["figure-ecdf", "figure-above"].forEach(id => { document.getElementById(id).dataset.query = "counterfactual_pairs"; });

const ecdfFigure = figure("figure-ecdf", "Distribution of OLC",
  () => (judged() ? `Share of the crashes with an OLC up to the value, ${judgedText()}${bandText("olc")}.`
    : `Share of ${scopeText()} with an OLC up to the value${bandText("olc")}. A curve that starts above 0 has left-censored vehicles: too little deceleration for an OLC, below every value.`),
  (svg, width) => drawDistributions(svg, width, "olc", "OLC, g", "g"),
  () => distributionContent("olc", "olc_g"));

const deltaVFigure = figure("figure-delta-v", "Distribution of delta-v",
  () => (judged() ? `Share of the crashes with a delta-v up to the value, ${judgedText()}${bandText("delta_v")}.`
    : `Share of ${scopeText()} with a delta-v up to the value: the change of velocity over the whole crash, rebound included.`)
    + (under("delta_v").length ? " Broad grey: real crashes, vehicles struck on the front and towed away, without rebound." : ""),
  (svg, width) => drawDistributions(svg, width, "delta_v", "delta-v, km/h", "km/h"),
  () => distributionContent("delta_v", "delta_v_km_h"));

// ---- crashes above a severity ------------------------------------------------------------------------

// Curves of "olc" (g) or "delta_v" (km/h); in the counterfactual design over the crashes judged with every treatment.
function above(what) {
  const of = (name, c, factor) => ({ variant: indexOf(name), name: name, x: c.x.map(v => factor * v), crashes: c.crashes, at_least: c.at_least, at_most: c.at_most, per_million_km: c.per_million_km, low: c.low, high: c.high });
  const list = judged() ? judgedVariants().map(v => of(v.variant, v[what], 1)) : shownVariants().map(v => of(v.variant, v.crashes_above[what].curve, what === "olc" ? 1 : 3.6));
  return list.filter(c => !missing(c.per_million_km[0]));
}

function drawAbove(svg, width, what, xTitle, unit) {
  const curves = above(what), top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: c.name })), lineMark);
  const margin = { top: top + 4, right: 16, bottom: 48, left: 76 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
  const step = curves[0].x[1] - curves[0].x[0], last = (d3.max(curves, c => d3.max(c.x.filter((x, k) => c.crashes[k] > 0))) || step) + 2 * step;
  const x = d3.scaleLinear().domain([0, last]).range([0, width - margin.left - margin.right]);
  const y = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.high)) || 1]).nice().range([height - margin.top - margin.bottom, 0]);
  const inner = frame(svg, width, height, margin, x, y, xTitle, "crashes above it per 10⁶ veh-km"), shown = c => c.x.filter(v => v <= last + step / 2);
  curves.forEach(c => inner.append("path").attr("class", "band").attr("d", d3.area().x(v => x(v)).y0((v, k) => y(c.low[k])).y1((v, k) => y(c.high[k]))(shown(c))).style("fill", colour(c.variant)).style("opacity", 0.16));
  curves.forEach(c => inner.append("path").attr("class", "curve").attr("d", d3.line().x(v => x(v)).y((v, k) => y(c.per_million_km[k]))(shown(c))).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]));
  readout(svg, inner, x, y.range()[0], value => { const k = Math.min(curves[0].x.length - 1, Math.round(value / step)); return [`above ${Number(curves[0].x[k].toFixed(1))} ${unit}`, ...curves.map(c => `${c.name}: ${rate(c.per_million_km[k])} (${rate(c.low[k])} to ${rate(c.high[k])})`)]; });
  return height;
}

function aboveContent(what, unit) {
  const rows = [], round = x => Number(x.toFixed(4));
  above(what).forEach(c => c.x.forEach((x, k) => rows.push(judged() ? [c.name, round(x), c.crashes[k], c.per_million_km[k], c.low[k], c.high[k]] : [c.name, round(x), c.crashes[k], c.at_least[k], c.at_most[k], c.per_million_km[k], c.low[k], c.high[k]])));
  const place = 15;
  return { summary: above(what).map(c => `${c.name}: ${rate(c.per_million_km[place])} above ${round(c.x[place])} ${unit}`).join("; "),
    columns: ["variant", what === "olc" ? "above_olc_g" : "above_delta_v_km_h", "crashes", ...(judged() ? [] : ["at_least", "at_most"]), "per_million_km", "low", "high"], rows: rows };
}

const aboveText = what => `Frontal crashes whose ${what} exceeds the value, per million vehicle-km: rate and severity in one. ` + (judged() ?
  `Per vehicle-km of the baseline, ${judgedText()}; new crashes between others are not in it. Band: 95 % at each value by itself.` :
  "A treatment cannot change it by moving crashes out of what is looked at. The larger one of the frontally struck vehicles of a crash, extrapolated ones included; band: 95 % at each value by itself. The table has how many are certain, and how many possible, if severities outside the validated range count as unknown.");

const aboveFigure = figure("figure-above", "Crashes above an OLC", () => aboveText("OLC"),
  (svg, width) => drawAbove(svg, width, "olc", "OLC, g", "g"), () => aboveContent("olc", "g"));

const aboveDeltaVFigure = figure("figure-above-delta-v", "Crashes above a delta-v", () => aboveText("delta-v"),
  (svg, width) => drawAbove(svg, width, "delta_v", "delta-v, km/h", "km/h"), () => aboveContent("delta_v", "km/h"));

// ---- differences of OLC with their intervals -------------------------------------------------------

// One row a treatment and measure: {name, what, value, low, high, status}; null bounds are open.
function differences() {
  const rows = [];
  shownContrasts().forEach(c => {
    const o = c.olc_g;
    [["median", o.median_difference, o.median_interval], ["mean", o.mean_difference, o.mean_interval], ["90 % quantile", o.p90_difference, o.p90_interval]]
      .forEach(([what, e, i]) => rows.push({ name: c.variant, what: `difference of ${what}`, value: missing(e) || e.relation !== "=" ? null : e.value, low: i.low, high: i.high, status: i.status }));
  });
  shownPairs().forEach(c => [["all_pairs", "all pairs, avoided = 0 g"], ["conditional_on_crashing", "conditional on crashing"]].forEach(([key, what]) => {
    const p = c.olc_change_g[key], i = p.hodges_lehmann_interval;
    rows.push({ name: c.variant, what: `${what} (n = ${p.pairs})`, value: p.hodges_lehmann, low: i.low, high: i.high, status: i.status });
  }));
  return rows.filter(r => !missing(r.value));
}

const differenceFigure = figure("figure-difference", "Change of OLC against the baseline",
  () => (slice().counterfactual.length ? "Hodges–Lehmann estimate of the change within pairs, of the larger OLC of a crash’s frontally struck vehicles" : "Treatment minus baseline, both at the same mix of scenarios, over all frontally struck vehicles") + `, with 95 % bootstrap intervals over replications; without one, the reason stands beside the value. Means of left-censored vehicles are not known and not drawn. Left of zero: less severe.`,
  function (svg, width) {
    const rows = differences(), narrow = width <= 460, margin = { top: 10, right: 16, bottom: 48, left: 16 }, band = narrow ? 62 : 46, h = band * rows.length, w = width - margin.left - margin.right;
    const reach = d3.max(rows, r => d3.max([r.value, r.low, r.high].filter(v => !missing(v)).map(Math.abs))) || 1;
    const x = d3.scaleLinear().domain([-reach, reach]).nice().range([0, w]);
    const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`), ticks = Math.max(3, Math.round(w / 80));
    inner.selectAll(null).data(x.ticks(ticks)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
    inner.append("line").attr("y2", h).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--ink)");
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(ticks).tickSizeOuter(0));
    inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("change of OLC, g");
    rows.forEach((r, k) => {
      const v = indexOf(r.name), y = band * (k + 1) - 14;
      const label = inner.append("text").attr("class", "over").attr("y", y - (narrow ? 29 : 15));
      label.append("tspan").style("font-weight", 600).text(r.name);
      label.append("tspan").attr("class", "soft").attr("x", narrow ? 0 : null).attr("dy", narrow ? 15 : null)
        .text(`${narrow ? "" : "  "}${r.what}: ${fixed(r.value, 1)} g${narrow ? "" : ` (${interval({ status: r.status, low: r.low, high: r.high }, n => fixed(n, 1))})`}`);
      if (r.status === "value") inner.append("line").attr("x1", x(missing(r.low) ? x.domain()[0] : r.low)).attr("x2", x(missing(r.high) ? x.domain()[1] : r.high)).attr("y1", y).attr("y2", y).style("stroke", colour(v)).style("stroke-width", 2.4);
      inner.append("path").attr("d", symbol(v, 80)).attr("transform", `translate(${x(r.value)},${y})`).style("fill", colour(v));
    });
    return margin.top + h + margin.bottom;
  },
  function () {
    const rows = differences().map(r => [r.name, r.what, r.value, r.low, r.high, r.status]);
    return { summary: rows.map(r => `${r[0]}, ${r[1]}: ${fixed(r[2], 1)} g`).join("; "), columns: ["treatment", "change", "olc_g", "low", "high", "interval"], rows: rows };
  });

// ---- pairs one by one: OLC without and with the treatment -----------------------------------------

const inSlice = (columns, k) => (state.scenario === "" || data.scenarios[columns.scenario[k]] === state.scenario) &&
  (state.crashType === "" || data.crash_types[columns.crash_type[k]] === state.crashType);

// Points {variant, baseline, treated, name}: a crash and what became of it, or a seed run with both.
function crashPairs() {
  const c = data.pairs.crash;
  return d3.range(c.variant.length).filter(k => state.variants.has(c.variant[k]) && inSlice(c, k)).map(k => ({ variant: c.variant[k], baseline: c.baseline_olc_g[k], treated: c.treated_olc_g[k],
    name: `${data.scenarios[c.scenario[k]]}, ${data.crash_types[c.crash_type[k]]}, ${readable(c.outcome[k])}` }));
}
function seedPairs() {
  const c = data.pairs.seed, suffix = state.scope === "inside" ? "_inside" : "", reference = data.variants.findIndex(v => v.is_baseline), points = [];
  const means = d3.rollup(d3.range(c.variant.length).filter(k => inSlice(c, k) && c["vehicles" + suffix][k] > 0),
    ks => d3.sum(ks, k => c["vehicles" + suffix][k] * c["mean_olc_g" + suffix][k]) / d3.sum(ks, k => c["vehicles" + suffix][k]),
    k => c.scenario[k], k => c.number[k], k => c.variant[k]);
  means.forEach((numbers, scenario) => numbers.forEach((own, number) => own.forEach((treated, variant) => {
    if (variant !== reference && state.variants.has(variant) && own.has(reference))
      points.push({ variant: variant, baseline: own.get(reference), treated: treated, name: `${data.scenarios[scenario]}, replication ${number}` });
  })));
  return points;
}
const pairs = () => (data.pairs.crash ? crashPairs() : seedPairs());
const seedsRun = () => d3.sum(data.pairs.seeds.filter((n, k) => !state.scenario || data.scenarios[k] === state.scenario));

if (data.pairs && data.pairs.crash) document.getElementById("figure-paired").dataset.query = "counterfactual_pairs";
const pairedFigure = !data.pairs ? null : figure("figure-paired", "OLC without and with the treatment, pair by pair",
  () => (data.pairs.crash
    ? "A point is a frontal crash of the baseline: across its OLC, up what it became with the treatment, 0 when avoided; the larger of its frontally struck vehicles."
    : `A point is a seed run with both: mean OLC over ${scopeText()}, left-censored ones as 0 g. Of ${integer(seedsRun())} seeds, those with such a vehicle in both runs; traffic differs after the first intervention, so a pair is of seeds, not of crashes.`) +
    " Below the line: less severe." + (data.pairs.crash ? thinned() : ""),
  function (svg, width) {
    const points = pairs(), top = legend(svg, width, [...new Set(points.map(p => p.variant))].sort(d3.ascending).map(v => ({ variant: v, label: `${data.variants[v].name} (n = ${points.filter(p => p.variant === v).length}, ${points.filter(p => p.variant === v && p.treated < p.baseline).length} lower)` })), pointMark);
    const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const reach = d3.max(points, p => Math.max(p.baseline, p.treated)) || 1;
    const x = d3.scaleLinear().domain([0, reach]).nice().range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([0, reach]).nice().range([height - margin.top - margin.bottom, 0]);
    const inner = frame(svg, width, height, margin, x, y, "OLC with the baseline, g", "with the treatment, g");
    inner.append("line").attr("x1", x(0)).attr("y1", y(0)).attr("x2", x(x.domain()[1])).attr("y2", y(y.domain()[1])).style("stroke", "var(--ink)").style("stroke-dasharray", "4 4");
    const size = points.length > 500 ? 18 : 38;
    points.forEach(p => inner.append("path").attr("class", "point").attr("d", symbol(p.variant, size)).attr("transform", `translate(${x(p.baseline)},${y(p.treated)})`)
      .style("fill", colour(p.variant)).style("fill-opacity", 0.65).style("stroke", colour(p.variant)).style("stroke-width", 1.1)
      .append("title").text(`${data.variants[p.variant].name}, ${p.name}: ${fixed(p.baseline, 1)} g, with the treatment ${fixed(p.treated, 1)} g`));
    return height;
  },
  function () {
    const points = pairs();
    return { summary: `${points.length} pairs, ${points.filter(p => p.treated < p.baseline).length} less severe with the treatment`, columns: ["treatment", "pair", "baseline_olc_g", "treated_olc_g", "change_g"],
      rows: points.map(p => [data.variants[p.variant].name, p.name, p.baseline, p.treated, p.treated - p.baseline]) };
  });

// ---- OLC against closing speed -------------------------------------------------------------------

const scatterFigure = figure("figure-scatter", "OLC against closing speed",
  () => `${scopeText().replace(/^./, c => c.toUpperCase())}; filled: inside the validated range, hollow: extrapolated. Ticks at the bottom: left-censored vehicles.` + treatedText() + thinned(),
  function (svg, width) {
    const rows = chosen().filter(k => vehicles.status[k] !== FAILED);
    const names = data.variants.map((v, k) => ({ variant: k, label: v.name })).filter(n => state.variants.has(n.variant));
    const top = legend(svg, width, names, pointMark);
    const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const x = d3.scaleLinear().domain([0, d3.max(rows, k => vehicles.closing_speed_km_h[k]) || 1]).nice().range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([0, d3.max(rows, k => vehicles.olc_g[k]) || 1]).nice().range([height - margin.top - margin.bottom, 0]);
    const inner = frame(svg, width, height, margin, x, y, "closing speed, km/h", "OLC, g");
    const size = rows.length > 2000 ? 14 : rows.length > 500 ? 24 : 38;
    rows.forEach(k => {
      const v = vehicles.variant[k], inside = vehicles.validity[k] === 0, across = x(vehicles.closing_speed_km_h[k]);
      if (vehicles.status[k] === CENSORED) {
        inner.append("line").attr("x1", across).attr("x2", across).attr("y1", y(0)).attr("y2", y(0) - 10).style("stroke", colour(v)).style("stroke-width", 2);
        return;
      }
      inner.append("path").attr("class", "point").attr("d", symbol(v, size)).attr("transform", `translate(${across},${y(vehicles.olc_g[k])})`)
        .style("fill", inside ? colour(v) : "none").style("fill-opacity", 0.7).style("stroke", colour(v)).style("stroke-width", 1.1)
        .append("title").text(`${data.variants[v].name}, ${data.scenarios[vehicles.scenario[k]]}, ${data.crash_types[vehicles.crash_type[k]]}: ${fixed(vehicles.olc_g[k], 1)} g at ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h, ${readable(data.validity[vehicles.validity[k]])}`);
    });
    return height;
  },
  function () {
    const rows = chosen().filter(k => vehicles.status[k] !== FAILED).map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]],
      data.crash_types[vehicles.crash_type[k]], vehicles.closing_speed_km_h[k], vehicles.olc_g[k], vehicles.status[k] === CENSORED ? "left-censored" : "value", data.validity[vehicles.validity[k]]]);
    return { summary: `${rows.length} vehicles`, columns: ["variant", "scenario", "crash_type", "closing_speed_km_h", "olc_g", "olc_status", "validity"], rows: rows };
  });

function thinned() {
  const s = data.sample;
  return s.chance < 1 ? ` Drawn: a random sample of about ${integer(Math.round(s.chance * s.frontal_crashes))} of ${integer(s.frontal_crashes)} frontal crashes (seed ${s.seed}); counts, curves and tables use all.` : "";
}
