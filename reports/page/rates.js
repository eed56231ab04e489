// SPDX-License-Identifier: GPL-3.0-or-later
// How often it crashes: crash rates.

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
      label.append("tspan").attr("class", "soft").text(`  ${crashes(v.frontal_crashes)} in ${integer(Math.round(v.vehicle_km))} veh-km${width < 460 ? "" : `, dispersion ${fixed(r.widening.dispersion, 2)}`}`);
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
