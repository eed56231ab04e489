// SPDX-License-Identifier: GPL-3.0-or-later
// Scenario by scenario beside all of them; over more and more replications; over a swept parameter.

// The headline figure of a treatment in a slice, {value, interval}: the rate ratio, counterfactual the
// share of the valid pairs that were avoided.
const PAIRS = data.study.design === "counterfactual";
function headline(s, name) {
  const c = (PAIRS ? s.counterfactual : s.contrasts).find(k => k.variant === name);
  if (!c) return null;
  if (!PAIRS) return { value: c.rate_ratio, interval: c.rate_ratio_interval, counts: c.frontal_crashes };
  return { value: c.valid ? c.outcomes.avoided / c.valid : null, interval: c.shares.avoided, counts: [c.valid, c.outcomes.avoided] };
}
const HEADLINE = PAIRS ? "share of crashes avoided" : "frontal crash rate over that of the baseline";
const headlineText = value => (PAIRS ? percent(value) : ratio(value));
const known = i => i && i.status === "value";

// ---- forest plot -----------------------------------------------------------------------------------

const sliceOf = (scenario, type) => data.slices.find(s => (s.scenario || "") === scenario && (s.crash_type || "") === type);

// Rows of each treatment: its scenarios, then all of them together.
function forestRows() {
  const rows = [], scenarios = state.scenario ? [state.scenario] : data.scenarios;
  data.variants.forEach((v, k) => {
    if (v.is_baseline || !state.variants.has(k)) return;
    const own = scenarios.map(name => Object.assign({ label: readable(name), all: false }, headline(sliceOf(name, state.crashType), v.name)));
    const total = Object.assign({ label: PAIRS ? "all scenarios" : "all scenarios, stratified", all: true }, headline(sliceOf("", state.crashType), v.name));
    own.concat(scenarios.length > 1 ? total : []).filter(r => r.counts).forEach(r => rows.push(Object.assign({ variant: k, name: v.name }, r)));
  });
  return rows;
}

// Ratios on a logarithmic axis; 0 and infinity lie at its ends.
function forestScale(rows, w) {
  if (PAIRS) return d3.scaleLinear().domain([0, 1]).range([0, w]).clamp(true);
  const values = d3.merge(rows.map(r => [r.value, known(r.interval) ? r.interval.low : null, known(r.interval) ? r.interval.high : null])).filter(v => !missing(v) && v > 0);
  const low = Math.max(0.01, Math.min(0.5, d3.min(values) || 0.5)), high = Math.min(100, Math.max(2, d3.max(values) || 2));
  return d3.scaleLog().domain([low * 0.9, high * 1.1]).range([0, w]).clamp(true);
}

const forestFigure = !data.variants.some(v => !v.is_baseline) ? null : figure("figure-forest", "Scenario by scenario",
  () => (PAIRS ? "Share of the baseline’s valid frontal crashes that were avoided, with 95 % intervals that allow for what replications scatter."
    : "Rate of frontal crashes over that of the baseline, with 95 % intervals; logarithmic. Diamond: all scenarios together, each compared within itself (Mantel and Haenszel’s ratio), so that a different mix of scenarios cannot pass for an effect.") + " Without an interval the reason is in the table.",
  function (svg, width) {
    const rows = forestRows(), margin = { top: 8, right: 16, bottom: 48, left: 16 }, band = 38, gap = 24;
    let y = margin.top, last = null;
    rows.forEach(r => { y += r.name === last ? 0 : gap; last = r.name; r.y = y + 27; y += band; });
    const w = width - margin.left - margin.right, x = forestScale(rows, w), h = y - margin.top;
    const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    const ticks = PAIRS ? x.ticks(5) : [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].filter(t => t >= x.domain()[0] && t <= x.domain()[1]);
    inner.selectAll(null).data(ticks).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
    if (!PAIRS) inner.append("line").attr("y2", h).attr("x1", x(1)).attr("x2", x(1)).style("stroke", "var(--ink)");
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).tickValues(ticks).tickFormat(PAIRS ? d3.format(".0%") : String).tickSizeOuter(0));
    inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text(HEADLINE);
    rows.forEach((r, k) => {
      const at = r.y - margin.top;
      if (k === 0 || rows[k - 1].name !== r.name) inner.append("text").attr("class", "over").attr("y", at - 29).style("font-weight", 600).text(r.name);
      const label = inner.append("text").attr("class", "over").attr("y", at - 13);
      label.append("tspan").style("font-weight", r.all ? 600 : 400).text(r.label);
      label.append("tspan").attr("class", "soft").text(`  ${headlineText(r.value)}${known(r.interval) ? ` (${interval(r.interval, headlineText)})` : ""}${width > 460 ? PAIRS ? `, ${r.counts[1]} of ${r.counts[0]}` : `, ${r.counts[1]} against ${r.counts[0]} crashes` : ""}`);
      if (missing(r.value)) return;
      if (known(r.interval)) inner.append("line").attr("class", "interval").attr("x1", x(r.interval.low || x.domain()[0])).attr("x2", missing(r.interval.high) ? w : x(r.interval.high)).attr("y1", at).attr("y2", at).style("stroke", colour(r.variant)).style("stroke-width", r.all ? 3.4 : 2);
      inner.append("path").attr("class", "estimate").attr("d", d3.symbol().type(r.all ? d3.symbolDiamond : d3.symbolSquare).size(r.all ? 150 : 60)()).attr("transform", `translate(${x(r.value || x.domain()[0])},${at})`).style("fill", colour(r.variant));
    });
    return margin.top + h + margin.bottom;
  },
  function () {
    const rows = forestRows().map(r => [r.name, r.label, r.value, known(r.interval) ? r.interval.low : null, known(r.interval) ? r.interval.high : null, r.interval ? r.interval.status : "", r.counts[0], r.counts[1]]);
    return { summary: rows.map(r => `${r[0]}, ${r[1]}: ${headlineText(r[2])}`).join("; "), columns: ["treatment", "scenario", PAIRS ? "avoided_1" : "rate_ratio", "low", "high", "interval", PAIRS ? "valid_pairs" : "baseline_crashes", PAIRS ? "avoided" : "treatment_crashes"], rows: rows };
  });

// ---- convergence -----------------------------------------------------------------------------------

const converging = () => slice().convergence.series.filter(s => state.variants.has(indexOf(s.variant)) || slice().convergence.what === "rate");
const CONVERGING = { rate: "frontal crashes per 10⁶ veh-km", rate_ratio: HEADLINE, avoided: HEADLINE };
const convergingText = value => (slice().convergence.what === "rate" ? rate(value) : headlineText(value));

const convergenceFigure = figure("figure-convergence", "Convergence",
  () => `The headline figure over the first replications, then over more and more of them, as many of every scenario: when the curve still wanders at its end, more are needed. Band: 95 % from counts of crashes, widened by what replications scatter, at each number by itself.`,
  function (svg, width) {
    const curves = converging(), what = slice().convergence.what, top = legend(svg, width, curves.map(c => ({ variant: indexOf(c.variant), label: c.variant })), lineMark);
    const margin = { top: top + 4, right: 16, bottom: 48, left: 66 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const most = d3.max(curves, c => d3.max(c.value.filter(v => !missing(v)))) || 1, ends = d3.merge(curves.map(c => c.high)).filter(v => !missing(v)).sort(d3.ascending);
    // An interval of the first few may reach far; it is cut off there.
    const upper = what === "avoided" ? 1 : Math.min(d3.max(ends) || most, 3 * Math.max(most, d3.max(curves, c => c.high[c.high.length - 1]) || 0));
    const x = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.replications)) || 1]).range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([0, Math.max(upper, what === "rate_ratio" ? 1.2 : 0)]).nice().clamp(true).range([height - margin.top - margin.bottom, 0]);
    x.wholeNumbers = true;
    const inner = frame(svg, width, height, margin, x, y, PAIRS ? "replications of the baseline" : slice().contrasts.some(c => c.paired) ? "seeds run with both" : "replications", CONVERGING[what]);
    if (what === "rate_ratio") inner.append("line").attr("x2", x.range()[1]).attr("y1", y(1)).attr("y2", y(1)).style("stroke", "var(--ink)");
    curves.forEach(c => {
      const v = indexOf(c.variant), points = d3.range(c.value.length), there = points.filter(k => !missing(c.value[k]));
      inner.append("path").attr("class", "band").attr("d", d3.area().defined(k => !missing(c.low[k])).x(k => x(c.replications[k])).y0(k => y(c.low[k])).y1(k => y(missing(c.high[k]) ? y.domain()[1] : c.high[k]))(points)).style("fill", curves.length > 3 ? "none" : colour(v)).style("opacity", curves.length > 3 ? 0.5 : 0.14).style("stroke", curves.length > 3 ? colour(v) : "none").style("stroke-width", 0.8);
      inner.append("path").attr("class", "curve").attr("d", d3.line().x(k => x(c.replications[k])).y(k => y(c.value[k]))(there)).style("fill", "none").style("stroke", colour(v)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[v % 6]);
      if (there.length) inner.append("path").attr("d", symbol(v, 60)).attr("transform", `translate(${x(c.replications[there[there.length - 1]])},${y(c.value[there[there.length - 1]])})`).style("fill", colour(v));
    });
    return height;
  },
  function () {
    const rows = [];
    converging().forEach(c => c.value.forEach((value, k) => rows.push([c.variant, c.replications[k], value, c.low[k], c.high[k]])));
    return { summary: converging().map(c => `${c.variant}: ${convergingText(c.value[c.value.length - 1])} after ${c.replications[c.replications.length - 1]}`).join("; "), columns: ["variant", "replications", slice().convergence.what, "low", "high"], rows: rows };
  });

// ---- dose and response -----------------------------------------------------------------------------

// Every swept parameter: {parameter, owner, values}, and who has which value, by name.
const SWEPT = data.about.sweep || [];
const parametersSwept = [...new Set(SWEPT.map(s => s.parameter))].map(p => ({ parameter: p, owner: SWEPT.find(s => s.parameter === p).owner }));
const valueOf = (name, parameter) => { const s = SWEPT.find(k => k.name === name && k.parameter === parameter); return s ? s.value : null; };
const shortName = parameter => parameter.split(".").slice(-1)[0];
// What else is swept of a name, and what it is called in the study file: the line a point belongs to.
function restOf(name, parameter) {
  const own = SWEPT.filter(s => s.name === name);
  if (!own.length) return name;
  const rest = own.filter(s => s.parameter !== parameter).map(s => `${shortName(s.parameter)} ${s.value}`);
  return [own[0].base, ...rest].join(", ");
}

// Lines {label, points: [{x, value, interval}]} over one swept parameter.
function doseLines(swept) {
  const lines = new Map(), scenarios = state.scenario ? [state.scenario] : SWEPT.some(s => s.owner === "scenario") ? data.scenarios : [""];
  data.variants.forEach((v, k) => {
    if (v.is_baseline || !state.variants.has(k)) return;
    scenarios.forEach(scenario => {
      const x = valueOf(swept.owner === "variant" ? v.name : scenario, swept.parameter), h = headline(sliceOf(scenario, state.crashType), v.name);
      if (x === null || !h || missing(h.value)) return;
      const label = [restOf(v.name, swept.parameter), ...(scenario ? [restOf(scenario, swept.parameter)] : [])].join("; ");
      lines.set(label, (lines.get(label) || []).concat({ x: x, value: h.value, interval: h.interval, name: v.name, scenario: scenario }));
    });
  });
  return Array.from(lines, ([label, points], k) => ({ label: label, line: k + 1, points: points.sort((a, b) => a.x - b.x) }));
}

const doseFigures = parametersSwept.map(function (swept, place) {
  const node = document.createElement("figure");
  node.id = `figure-dose-${place + 1}`;
  document.getElementById("grid-dose").appendChild(node);
  return figure(node.id, `Over ${shortName(swept.parameter)}`,
    () => `${HEADLINE.replace(/^./, c => c.toUpperCase())}, over ${swept.parameter}; 95 % intervals. Lines join points of the same study and are no model.`,
    function (svg, width) {
      const lines = doseLines(swept), points = d3.merge(lines.map(l => l.points)), top = legend(svg, width, lines.map(l => ({ variant: l.line, label: l.label })), (g, v) => { lineMark(g, v); pointMark(g, v); });
      const margin = { top: top + 4, right: 22, bottom: 48, left: 66 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
      const span = d3.extent(points, p => p.x), pad = 0.06 * (span[1] - span[0] || 1), ends = points.map(p => (known(p.interval) && !missing(p.interval.high) ? p.interval.high : p.value));
      const x = d3.scaleLinear().domain([span[0] - pad, span[1] + pad]).range([0, width - margin.left - margin.right]);
      const y = d3.scaleLinear().domain([0, PAIRS ? 1 : Math.max(1.2, Math.min(d3.max(ends), 4 * d3.max(points, p => p.value)))]).nice().clamp(true).range([height - margin.top - margin.bottom, 0]);
      const inner = frame(svg, width, height, margin, x, y, shortName(swept.parameter), HEADLINE);
      if (!PAIRS) inner.append("line").attr("x2", x.range()[1]).attr("y1", y(1)).attr("y2", y(1)).style("stroke", "var(--ink)");
      lines.forEach(l => {
        // Lines side by side, so that intervals at the same value do not hide each other.
        const at = p => x(p.x) + 5 * (l.line - (lines.length + 1) / 2);
        inner.append("path").attr("class", "curve").attr("d", d3.line().x(at).y(p => y(p.value))(l.points)).style("fill", "none").style("stroke", colour(l.line)).style("stroke-width", 1.8).style("stroke-dasharray", DASHES[l.line % 6]);
        l.points.forEach(p => {
          if (known(p.interval)) inner.append("line").attr("class", "interval").attr("x1", at(p)).attr("x2", at(p)).attr("y1", y(p.interval.low)).attr("y2", y(missing(p.interval.high) ? y.domain()[1] : p.interval.high)).style("stroke", colour(l.line)).style("stroke-width", 1.8);
          inner.append("path").attr("class", "point").attr("d", symbol(l.line, 70)).attr("transform", `translate(${at(p)},${y(p.value)})`).style("fill", colour(l.line)).append("title").text(`${l.label}: ${headlineText(p.value)} (${interval(p.interval, headlineText)}) at ${p.x}`);
        });
      });
      return height;
    },
    function () {
      const rows = d3.merge(doseLines(swept).map(l => l.points.map(p => [l.label, p.x, p.value, known(p.interval) ? p.interval.low : null, known(p.interval) ? p.interval.high : null, p.interval.status])));
      return { summary: rows.map(r => `${r[0]}, ${r[1]}: ${headlineText(r[2])}`).join("; "), columns: ["line", shortName(swept.parameter), PAIRS ? "avoided_1" : "rate_ratio", "low", "high", "interval"], rows: rows };
    });
});
