// SPDX-License-Identifier: GPL-3.0-or-later
// How often it crashes: crash rates, crashes above a severity.

// ---- crash rates ----------------------------------------------------------------------------------

const rateFigure = figure("figure-rate", "Frontal crash rate",
  () => "Frontal crashes per million vehicle-km, of any validity. Thick: 95 % bootstrap over replications, from 20 replications on. Thin: 95 % interval of Poisson counts, widened by what replications scatter more (dispersion above 1), from any number of them; with one replication a scenario that is not known and not in it.",
  function (svg, width) {
    const rows = shownVariants(), margin = { top: 8, right: 16, bottom: 48, left: 16 };
    const band = Math.max(58, Math.min(104, 300 / rows.length)), height = margin.top + band * rows.length + margin.bottom, w = width - margin.left - margin.right;
    const upper = d3.max(rows, v => d3.max([v.frontal_crashes_per_million_km.value, v.frontal_crashes_per_million_km.widened.high, v.frontal_crashes_per_million_km.bootstrap.high]));
    const x = d3.scaleLinear().domain([0, upper || 1]).nice().range([0, w]);
    const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`), h = band * rows.length;
    const ticks = Math.max(3, Math.round(w / 90));
    inner.selectAll(null).data(x.ticks(ticks)).enter().append("line").attr("class", "gridline").attr("y2", h).attr("x1", x).attr("x2", x);
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(ticks).tickFormat(integer).tickSizeOuter(0));
    inner.append("text").attr("class", "axis-title").attr("x", w / 2).attr("y", h + 38).attr("text-anchor", "middle").text("frontal crashes per 10⁶ vehicle-km");
    rows.forEach((v, row) => {
      const k = indexOf(v.variant), r = v.frontal_crashes_per_million_km, y = band * (row + 0.5) + 10;
      const label = inner.append("text").attr("y", y - 16);
      label.append("tspan").style("font-weight", 600).text(v.variant);
      label.append("tspan").attr("class", "soft").text(`  ${v.frontal_crashes} crashes in ${integer(Math.round(v.vehicle_km))} veh-km${width < 460 ? "" : `, dispersion ${fixed(r.widening.dispersion, 2)}`}`);
      if (missing(r.value)) return;
      const bar = (i, thick) => i.status === "value" && inner.append("line").attr("x1", x(i.low)).attr("x2", x(i.high)).attr("y1", y).attr("y2", y)
        .style("stroke", colour(k)).style("stroke-width", thick).style("opacity", thick > 3 ? 0.45 : 1);
      bar(r.bootstrap, 9);
      bar(r.widened, 1.8);
      for (const end of r.widened.status === "value" ? [r.widened.low, r.widened.high] : [])
        inner.append("line").attr("x1", x(end)).attr("x2", x(end)).attr("y1", y - 6).attr("y2", y + 6).style("stroke", colour(k)).style("stroke-width", 1.8);
      inner.append("path").attr("d", symbol(k, 95)).attr("transform", `translate(${x(r.value)},${y})`).style("fill", colour(k));
    });
    return height;
  },
  function () {
    const rows = shownVariants().map(v => {
      const r = v.frontal_crashes_per_million_km, boot = r.bootstrap.status === "value";
      return [v.variant, v.replications, v.vehicle_km, v.frontal_crashes, r.value, r.widened.low, r.widened.high, boot ? r.bootstrap.low : r.bootstrap.status, boot ? r.bootstrap.high : r.bootstrap.status, r.widening.dispersion];
    });
    return {
      summary: shownVariants().map(v => `${v.variant}: ${rate(v.frontal_crashes_per_million_km.value)}`).join("; "),
      columns: ["variant", "replications", "vehicle_km", "frontal_crashes", "per_million_km", "widened_low", "widened_high", "bootstrap_low", "bootstrap_high", "dispersion"],
      rows: rows
    };
  });

// ---- crashes above a severity ------------------------------------------------------------------------

const above = () => shownVariants().map(v => Object.assign({ variant: indexOf(v.variant), name: v.variant }, v.crashes_above.olc.curve)).filter(c => !missing(c.per_million_km[0]));

const aboveFigure = figure("figure-above", "Crashes above a severity",
  () => "Frontal crashes whose OLC exceeds the value, per million vehicle-km: rate and severity in one, which a treatment cannot change by moving crashes out of what is looked at. The larger OLC of the frontally struck vehicles of a crash, extrapolated ones included; band: 95 % at each value by itself. The table has how many are certain, and how many possible, if severities outside the validated range count as unknown.",
  function (svg, width) {
    const curves = above(), top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: c.name })), lineMark);
    const margin = { top: top + 4, right: 16, bottom: 48, left: 66 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const last = d3.max(curves, c => d3.max(c.x.filter((x, k) => c.crashes[k] > 0))) || 1;
    const x = d3.scaleLinear().domain([0, last + 2]).range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([0, d3.max(curves, c => d3.max(c.high)) || 1]).nice().range([height - margin.top - margin.bottom, 0]);
    const inner = frame(svg, width, height, margin, x, y, "OLC, g", "crashes above it per 10⁶ veh-km"), shown = c => c.x.filter(v => v <= last + 2);
    curves.forEach(c => inner.append("path").attr("class", "band").attr("d", d3.area().x(v => x(v)).y0((v, k) => y(c.low[k])).y1((v, k) => y(c.high[k]))(shown(c))).style("fill", colour(c.variant)).style("opacity", 0.16));
    curves.forEach(c => inner.append("path").attr("d", d3.line().x(v => x(v)).y((v, k) => y(c.per_million_km[k]))(shown(c))).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]));
    readout(svg, inner, x, y.range()[0], value => { const k = Math.min(curves[0].x.length - 1, Math.round(value)); return [`above ${k} g`, ...curves.map(c => `${c.name}: ${rate(c.per_million_km[k])} (${rate(c.low[k])} to ${rate(c.high[k])})`)]; });
    return height;
  },
  function () {
    const rows = [];
    above().forEach(c => c.x.forEach((x, k) => rows.push([c.name, x, c.crashes[k], c.at_least[k], c.at_most[k], c.per_million_km[k], c.low[k], c.high[k]])));
    return { summary: shownVariants().map(v => `${v.variant}: ${rate(v.crashes_above.olc.per_million_km)} above ${v.crashes_above.olc.x} g`).join("; "), columns: ["variant", "above_olc_g", "crashes", "at_least", "at_most", "per_million_km", "low", "high"], rows: rows };
  });
