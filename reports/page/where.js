// SPDX-License-Identifier: GPL-3.0-or-later
// How and where they meet: crash configurations, crash sites.

// ---- configuration map ---------------------------------------------------------------------------

const mapRows = () => {
  // One point a crash: the vehicle of role a stands for both.
  return chosen().filter(k => vehicles.role[k] === 0);
};
const speedColour = d3.scaleSequential(d3.interpolateViridis).domain([130, 0]).clamp(true);

const mapFigure = figure("figure-map", "Crash configurations",
  () => "Frontal crashes by lateral offset of the opponent and angle (0° = exactly oncoming, ±90° = crossing), seen from the vehicle struck on its front; colour: closing speed. Filled: that vehicle is inside the validated range." + treatedText() + thinned(),
  function (svg, width) {
    const rows = mapRows(), variants = data.variants.map((v, k) => k).filter(k => state.variants.has(k)), count = variants.length;
    const legendWidth = Math.min(220, width - 120), bar = svg.append("g").attr("transform", "translate(56,4)");
    d3.range(0, 44).forEach(k => bar.append("rect").attr("x", legendWidth * k / 44).attr("width", legendWidth / 44 + 0.5).attr("height", 8).style("fill", speedColour(130 * k / 43)));
    [0, 65, 130].forEach(v => bar.append("text").attr("x", legendWidth * v / 130).attr("y", 22).attr("text-anchor", "middle").text(v === 130 ? "≥ 130 km/h" : v));
    const top = 30, columns = width >= 460 && count > 1 ? 2 : 1, panelWidth = width / columns;
    const margin = { top: 30, right: 14, bottom: 48, left: 56 }, panelHeight = count > columns ? 270 : Math.min(330, 140 + width * 0.35) + 78;
    const extent = d3.max(rows, k => Math.abs(vehicles.lateral_offset_m[k])) || 1;
    const limit = d3.max(rows, k => Math.abs(vehicles.angle_deg[k])) || 1;
    const x = d3.scaleLinear().domain([-extent, extent]).nice().range([0, panelWidth - margin.left - margin.right]);
    const reach = Math.min(180, 45 * Math.ceil(limit / 45)), angles = d3.range(-reach, reach + 1, reach > 45 ? 45 : 15);
    const y = d3.scaleLinear().domain([-reach, reach]).range([panelHeight - margin.top - margin.bottom, 0]);
    variants.forEach((variant, place) => {
      const own = rows.filter(k => vehicles.variant[k] === variant);
      const panel = svg.append("g").attr("transform", `translate(${(place % columns) * panelWidth},${top + Math.floor(place / columns) * panelHeight})`);
      const title = panel.append("text").attr("x", margin.left).attr("y", 18);
      title.append("tspan").style("font-weight", 600).text(data.variants[variant].name);
      title.append("tspan").attr("class", "soft").text(`  ${crashes(own.length)}`);
      const inner = frame(panel, panelWidth, panelHeight, margin, x, y, "lateral offset, m", "angle, °", angles);
      inner.append("line").attr("x2", x.range()[1]).attr("y1", y(0)).attr("y2", y(0)).style("stroke", "var(--soft)");
      inner.append("line").attr("y2", y.range()[0]).attr("x1", x(0)).attr("x2", x(0)).style("stroke", "var(--soft)");
      own.forEach(k => inner.append("path").attr("d", symbol(variant, own.length > 500 ? 16 : 34))
        .attr("transform", `translate(${x(vehicles.lateral_offset_m[k])},${y(vehicles.angle_deg[k])})`)
        .style("fill", vehicles.validity[k] === 0 ? speedColour(vehicles.closing_speed_km_h[k]) : "none").style("fill-opacity", 0.85).style("stroke", speedColour(vehicles.closing_speed_km_h[k])).style("stroke-width", 1.2)
        .append("title").text(`${fixed(vehicles.lateral_offset_m[k], 2)} m, ${fixed(vehicles.angle_deg[k], 0)}°, ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h, ${readable(data.validity[vehicles.validity[k]])}`));
    });
    return top + panelHeight * Math.ceil(count / columns);
  },
  function () {
    const rows = mapRows().map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]], data.crash_types[vehicles.crash_type[k]],
      vehicles.lateral_offset_m[k], vehicles.angle_deg[k], vehicles.closing_speed_km_h[k], data.validity[vehicles.validity[k]]]);
    return { summary: crashes(rows.length, "frontal"), columns: ["variant", "scenario", "crash_type", "lateral_offset_m", "angle_deg", "closing_speed_km_h", "validity"], rows: rows };
  });

// ---- crash sites on the network --------------------------------------------------------------------

const siteFigure = figure("figure-sites", "Crash sites",
  () => "Where the first contacts lie, on the lanes of the SUMO network; metres, equal scale both ways." + data.networks.map((n, k) => n.missing ? ` ${readable(data.scenarios[k])}: drawn without its network, ${n.missing}.` : "").join("") + treatedText() + thinned(),
  function (svg, width) {
    const rows = mapRows(), names = data.variants.map((v, k) => ({ variant: k, label: v.name })).filter(n => state.variants.has(n.variant));
    let top = legend(svg, width, names, pointMark) + 6;
    data.scenarios.forEach((name, scenario) => {
      const own = rows.filter(k => vehicles.scenario[k] === scenario);
      if (own.length === 0) return;
      const lanes = data.networks[scenario].lanes || [];
      const x0 = d3.extent(own, k => vehicles.x_m[k]), y0 = d3.extent(own, k => vehicles.y_m[k]);
      const pad = Math.max(25, 0.1 * Math.max(x0[1] - x0[0], y0[1] - y0[0]));
      const box = { x: [x0[0] - pad, x0[1] + pad], y: [y0[0] - pad, y0[1] + pad] };
      const w = width - 16, most = Math.min(420, 0.7 * width), spanX = box.x[1] - box.x[0], spanY = box.y[1] - box.y[0];
      const scale = Math.min(w / spanX, most / spanY), h = Math.max(90, Math.min(most, spanY * scale));
      const cx = (box.x[0] + box.x[1]) / 2, cy = (box.y[0] + box.y[1]) / 2;
      const X = v => 8 + w / 2 + (v - cx) * scale, Y = v => h / 2 - (v - cy) * scale;
      const title = svg.append("text").attr("x", 8).attr("y", top + 12);
      title.append("tspan").style("font-weight", 600).text(readable(name));
      title.append("tspan").attr("class", "soft").text(`  ${crashes(own.length)}`);
      const panel = svg.append("g").attr("transform", `translate(0,${top + 20})`), clip = `clip-${scenario}-${Math.round(width)}`;
      panel.append("clipPath").attr("id", clip).append("rect").attr("x", 8).attr("width", w).attr("height", h);
      panel.append("rect").attr("x", 8).attr("width", w).attr("height", h).style("fill", "none").style("stroke", "var(--line)");
      const roads = panel.append("g").attr("clip-path", `url(#${clip})`);
      lanes.forEach(lane => {
        const points = d3.range(0, lane.length, 2).map(k => `${X(lane[k]).toFixed(1)},${Y(lane[k + 1]).toFixed(1)}`);
        roads.append("polyline").attr("points", points.join(" ")).style("fill", "none").style("stroke", "var(--line)").style("stroke-width", Math.max(1, 3.2 * scale)).style("stroke-linecap", "round");
      });
      own.forEach(k => roads.append("path").attr("class", "site").attr("d", symbol(vehicles.variant[k], own.length > 300 ? 22 : 40))
        .attr("transform", `translate(${X(vehicles.x_m[k])},${Y(vehicles.y_m[k])})`).style("fill", colour(vehicles.variant[k])).style("fill-opacity", 0.65).style("stroke", "var(--surface)").style("stroke-width", 0.5)
        .append("title").text(`${data.variants[vehicles.variant[k]].name}: ${fixed(vehicles.closing_speed_km_h[k], 0)} km/h at ${fixed(vehicles.x_m[k], 0)}, ${fixed(vehicles.y_m[k], 0)}`));
      const unit = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000].filter(m => m * scale < w / 3).pop() || 10;
      panel.append("line").attr("x1", 20).attr("x2", 20 + unit * scale).attr("y1", h - 12).attr("y2", h - 12).style("stroke", "var(--ink)").style("stroke-width", 2);
      panel.append("text").attr("x", 20).attr("y", h - 18).text(`${unit} m`);
      top += h + 34;
    });
    return top;
  },
  function () {
    const rows = mapRows().map(k => [data.variants[vehicles.variant[k]].name, data.scenarios[vehicles.scenario[k]], data.crash_types[vehicles.crash_type[k]], vehicles.x_m[k], vehicles.y_m[k], vehicles.closing_speed_km_h[k]]);
    return { summary: crashes(rows.length, "frontal"), columns: ["variant", "scenario", "crash_type", "x_m", "y_m", "closing_speed_km_h"], rows: rows };
  });
