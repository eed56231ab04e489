// SPDX-License-Identifier: GPL-3.0-or-later
// What became of it: counterfactual outcomes, expected injuries.

// ---- counterfactual outcomes as a flow ----------------------------------------------------------------

const OUTCOMES = ["avoided", "mitigated", "unchanged", "aggravated", "changed_opponent", "invalid"];
const OUTCOME_COLOUR = { avoided: "var(--v3)", mitigated: "var(--v1)", unchanged: "var(--v0)", aggravated: "var(--v2)", changed_opponent: "var(--v4)", invalid: "var(--line)" };

// Crashes of others that the treatment brought about, and those it took away.
function between(t, width) {
  const parts = [[t.new_crashes, "new"], [t.vanished_crashes, "vanished"]].filter(p => p[0] > 0).map(p => width > 520 ? crashes(p[0], p[1]) : `${integer(p[0])} ${p[1]}`);
  return parts.length ? ` (${parts.join(" and ")}${width > 520 ? " between others besides" : " besides"})` : "";
}

const flowFigure = data.study.design !== "counterfactual" ? null : figure("figure-flow", "What became of the baseline’s frontal crashes",
  () => "Each baseline crash run again from a checkpoint before contact with the treatment on its two vehicles; outcomes by closing speed (±0.5 m/s), they add up to the baseline’s crashes. Shares are of the valid pairs, with 95 % intervals that allow for what replications scatter. The table has the crashes that were inside the validated range with the baseline apart.",
  function (svg, width) {
    const treatments = shownPairs(), panel = 250, left = 92, right = Math.min(290, Math.max(185, 0.52 * width));
    treatments.forEach((t, place) => {
      const g = svg.append("g").attr("transform", `translate(0,${place * panel + 22})`), height = panel - 60, scale = (height - 50) / Math.max(1, t.crashes);
      g.append("text").attr("x", 4).attr("y", -6).style("font-weight", 600).text(t.variant + between(t, width));
      g.append("rect").attr("x", left - 14).attr("width", 14).attr("height", Math.max(1, t.crashes * scale)).style("fill", "var(--v0)");
      g.append("text").attr("x", left - 20).attr("y", t.crashes * scale / 2).attr("text-anchor", "end").text(crashes(t.crashes));
      let from = 0, to = 0;
      const x1 = width - right;
      OUTCOMES.filter(o => t.outcomes[o] > 0).forEach(o => {
        const n = t.outcomes[o], h = n * scale, mid = (left + x1) / 2, share = t.shares[o];
        g.append("path").attr("d", `M${left},${from}C${mid},${from} ${mid},${to} ${x1},${to}V${to + h}C${mid},${to + h} ${mid},${from + h} ${left},${from + h}Z`)
          .style("fill", OUTCOME_COLOUR[o]).style("opacity", 0.45).append("title").text(`${readable(o)}: ${n}`);
        g.append("rect").attr("x", x1).attr("y", to).attr("width", 10).attr("height", Math.max(1, h)).style("fill", OUTCOME_COLOUR[o]);
        const words = g.append("text").attr("x", x1 + 16).attr("y", to + Math.max(h / 2, 4) + 4);
        words.append("tspan").style("font-weight", 600).text(`${readable(o)} ${n}${o === "aggravated" && width > 520 ? ` (by OLC ${t.outcomes_by_olc[o]})` : ""}`);
        if (o !== "invalid") words.append("tspan").attr("class", "soft").text(`  ${percent(n / t.valid)}${share && share.status === "value" && width > 520 ? ` (${interval(share, percent)})` : ""}`);
        from += h;
        to += Math.max(h, 16) + 4;
      });
    });
    return panel * treatments.length;
  },
  function () {
    const rows = [];
    shownPairs().forEach(t => OUTCOMES.forEach(o => rows.push([t.variant, o, t.outcomes[o], t.outcomes_by_olc[o], t.baseline_inside.outcomes[o], o === "invalid" ? null : t.outcomes[o] / t.valid, o === "invalid" ? null : t.shares[o].low, o === "invalid" ? null : t.shares[o].high])));
    return { summary: shownPairs().map(t => `${t.variant}: ${t.outcomes.avoided} of ${t.valid} valid pairs avoided`).join("; "), columns: ["treatment", "outcome", "crashes", "crashes_by_olc", "baseline_inside", "share_of_valid", "low", "high"], rows: rows };
  });

// ---- expected injuries --------------------------------------------------------------------------------

function benefits() {
  const rows = [];
  shownContrasts().forEach(c => c.injury_benefit.forEach(b => rows.push(Object.assign({ name: c.variant }, b))));
  shownPairs().forEach(c => c.injury_benefit.forEach(b => rows.push(Object.assign({ name: c.variant }, b))));
  return rows;
}

const benefitFigure = figure("figure-benefit", "Benefit in expected injured drivers",
  () => "Per cent fewer injured drivers per vehicle-km than with the baseline (counterfactual: of the same crashes, avoided = 0), by risk function, 95 % bootstrap over replications (none where crashes are too few), joined with what the coefficients of the function leave open. NASS-CDS: belted drivers of the vehicles struck on their front, delta-v without rebound; no function is of OLC. The table has what is left when severities outside the validated range count as unknown.",
  function (svg, width) {
    const rows = benefits().filter(b => !missing(b.benefit_1)), margin = { top: 10, right: 16, bottom: 48, left: 16 }, band = 40, h = band * rows.length, w = width - margin.left - margin.right;
    const low = d3.min(rows, b => d3.min([b.benefit_1, missing(b.interval.low) ? b.benefit_1 : b.interval.low])) || 0;
    const x = d3.scaleLinear().domain([Math.min(0, low), 1]).nice().range([0, w]), inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    inner.selectAll(null).data(x.ticks(6)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
    inner.append("line").attr("y2", h).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--ink)");
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(6).tickFormat(d3.format(".0%")).tickSizeOuter(0));
    inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("fewer expected injured drivers");
    rows.forEach((b, k) => {
      const v = indexOf(b.name), y = band * (k + 0.5) + 8, label = inner.append("text").attr("class", "over").attr("y", y - 13);
      label.append("tspan").style("font-weight", 600).text(b.name);
      label.append("tspan").attr("class", "soft").text(`  ${b.level} (${b.function}): ${percent(b.benefit_1)}${width > 460 ? ` (${interval(b.interval, percent)})` : ""}`);
      if (b.interval.status === "value") inner.append("line").attr("x1", x(missing(b.interval.low) ? x.domain()[0] : b.interval.low)).attr("x2", x(missing(b.interval.high) ? 1 : b.interval.high)).attr("y1", y).attr("y2", y).style("stroke", colour(v)).style("stroke-width", 2.4);
      inner.append("path").attr("d", symbol(v, 70)).attr("transform", `translate(${x(b.benefit_1)},${y})`).style("fill", colour(v));
    });
    return margin.top + h + margin.bottom;
  },
  function () {
    const rows = benefits().map(b => [b.name, b.level, b.function, b.baseline, b.treatment, b.benefit_1, b.interval.low, b.interval.high, b.interval.status, b.bounds_1[0], b.bounds_1[1]]);
    return { summary: rows.map(r => `${r[0]}, ${r[1]} (${r[2]}): ${percent(r[5])}`).join("; "), columns: ["treatment", "level", "function", "expected_baseline", "expected_treatment", "benefit_1", "low", "high", "interval", "at_least", "at_most"], rows: rows };
  });

// ---- injury risk ---------------------------------------------------------------------------------------

// Functions of a speed, over km/h; the levels have the colours, the functions the dashes.
const riskCurves = () => data.risks.filter(r => r.curve);
const riskLevels = [...new Set(data.risks.map(r => r.level))], riskNames = [...new Set(data.risks.map(r => r.name))];
const riskLabel = r => `${r.level} (${r.name})${r.curve.crash_type ? `, ${r.curve.crash_type}` : ""}`;
const riskStyle = (node, r) => node.style("stroke", `var(--v${1 + riskLevels.indexOf(r.level) % 5})`).style("stroke-dasharray", DASHES[riskNames.indexOf(r.name) % 6]).style("stroke-width", 2.2);

const riskFigure = figure("figure-risk", "Injury risk over delta-v",
  () => "Probability that a driver is injured at least so badly, by the functions that the table below sums up: what stands between delta-v and expected injuries. Beyond the crashes they were made from they extrapolate. A function of the crash type is drawn for front-front, one of the drivers as their mean; sources in the table.",
  function (svg, width) {
    const curves = riskCurves(), top = legend(svg, width, curves.map((r, k) => ({ variant: k, label: riskLabel(r) })), (g, k) => riskStyle(g.append("line").attr("x2", 18), curves[k]));
    const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const x = d3.scaleLinear().domain([0, d3.max(curves, r => d3.max(r.curve.x))]).range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([0, 1]).range([height - margin.top - margin.bottom, 0]);
    const inner = frame(svg, width, height, margin, x, y, curves.every(r => r.predictor.startsWith("delta_v")) ? "delta-v, km/h" : "predictor, km/h", "probability");
    curves.forEach(r => riskStyle(inner.append("path").attr("class", "curve").attr("d", d3.line().x(v => x(v)).y((v, k) => y(r.curve.probability[k]))(r.curve.x)).style("fill", "none"), r));
    readout(svg, inner, x, y.range()[0], value => [`${fixed(value, 0)} km/h`, ...curves.map(r => `${riskLabel(r)}: ${percent(r.curve.probability[Math.min(r.curve.x.length - 1, Math.round(value / (r.curve.x[1] - r.curve.x[0])))])}`)]);
    return height;
  },
  function () {
    const rows = d3.merge(riskCurves().map(r => r.curve.x.map((v, k) => [r.level, r.name, r.predictor, v, r.curve.probability[k]])));
    return { summary: riskCurves().map(r => `${riskLabel(r)}: ${percent(r.curve.probability[25])} at ${r.curve.x[25]} km/h`).join("; "), columns: ["level", "function", "predictor", "km_h", "probability"], rows: rows };
  });
