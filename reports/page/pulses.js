// SPDX-License-Identifier: GPL-3.0-or-later
// Pulse corridors and single crashes.

// ---- pulse corridors ------------------------------------------------------------------------------------

// Treated crashes of the counterfactual design have pulses too.
const corridors = () => shownVariants().concat((slice().treated || []).filter(v => state.variants.has(indexOf(v.variant)))).map(v => Object.assign({ variant: indexOf(v.variant), name: v.variant }, v.corridor[state.scope])).filter(c => c.p50.length > 0);
const STEP_MS = 2;

const corridorFigure = figure("figure-corridor", "Pulse corridors",
  () => `Deceleration along the car’s x axis over time, CFC60: median and, shaded, the range from 10 to 90 % at each instant, over up to ${data.sample.pulses} sampled vehicles of each variant among ${scopeText()}. From three vehicles on.`,
  function (svg, width) {
    const curves = corridors();
    const top = legend(svg, width, curves.map(c => ({ variant: c.variant, label: `${c.name} (${c.n} pulses)` })), lineMark);
    const margin = { top: top + 4, right: 16, bottom: 48, left: 52 }, height = margin.top + Math.min(330, 140 + width * 0.35) + margin.bottom;
    const x = d3.scaleLinear().domain([0, 150]).range([0, width - margin.left - margin.right]);
    const y = d3.scaleLinear().domain([Math.min(0, d3.min(curves, c => d3.min(c.p10))), d3.max(curves, c => d3.max(c.p90))]).nice().range([height - margin.top - margin.bottom, 0]);
    const inner = frame(svg, width, height, margin, x, y, "time from first contact, ms", "deceleration, g");
    curves.forEach(c => inner.append("path").attr("d", d3.area().x((p, k) => x(k * STEP_MS)).y0((p, k) => y(c.p10[k])).y1((p, k) => y(c.p90[k]))(c.p50)).style("fill", colour(c.variant)).style("opacity", 0.16));
    curves.forEach(c => inner.append("path").attr("d", d3.line().x((p, k) => x(k * STEP_MS)).y(y)(c.p50)).style("fill", "none").style("stroke", colour(c.variant)).style("stroke-width", 2.2).style("stroke-dasharray", DASHES[c.variant % 6]));
    readout(svg, inner, x, y.range()[0], t => { const k = Math.round(t / STEP_MS); return [`${k * STEP_MS} ms`, ...curves.map(c => k < c.p50.length ? `${c.name}: ${fixed(c.p50[k], 1)} g (${fixed(c.p10[k], 1)} to ${fixed(c.p90[k], 1)})` : `${c.name}: –`)]; });
    return height;
  },
  function () {
    const rows = [];
    corridors().forEach(c => c.p50.forEach((value, k) => rows.push([c.name, k * STEP_MS, c.p10[k], value, c.p90[k], c.n])));
    return { summary: corridors().map(c => `${c.name}: ${c.n} pulses, highest median ${fixed(d3.max(c.p50), 1)} g`).join("; "), columns: ["variant", "time_ms", "p10_g", "median_g", "p90_g", "pulses"], rows: rows };
  });

// ---- the gallery ---------------------------------------------------------------------------------------

// Both cars from above at a frame, drawn anew for each position of the slider.
function drawCrash(area, run, frameNumber) {
  const width = Math.max(240, area.clientWidth), xs = [], ys = [];
  run.vehicles.forEach(v => v.poses.forEach(p => { xs.push(p[0] - 2.6, p[0] + 2.6); ys.push(p[1] - 2.6, p[1] + 2.6); }));
  const x0 = d3.extent(xs), y0 = d3.extent(ys), scale = Math.min(width / (x0[1] - x0[0]), 230 / (y0[1] - y0[0]));
  const height = Math.max(120, scale * (y0[1] - y0[0])), degrees = rad => rad * 180 / Math.PI;
  area.textContent = "";
  const svg = d3.select(area).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height).attr("role", "img")
    .attr("aria-label", `From above, ${fixed(run.times_ms[frameNumber], 0)} ms after first contact`);
  const world = svg.append("g").attr("transform", `translate(${width / 2},${height / 2}) scale(${scale},${-scale}) translate(${-(x0[0] + x0[1]) / 2},${-(y0[0] + y0[1]) / 2})`);
  run.vehicles.forEach((v, role) => {
    const p = v.poses[frameNumber], car = world.append("g").attr("transform", `translate(${p[0]},${p[1]}) rotate(${degrees(p[2])})`);
    v.parts.forEach(part => {
      const f = part.frames[frameNumber];
      car.append("rect").attr("x", -f[3] / 2).attr("y", -part.width_m / 2).attr("width", f[3]).attr("height", part.width_m).attr("rx", part.radius_m)
        .attr("transform", `translate(${f[0]},${f[1]}) rotate(${degrees(f[2])})`).style("fill", `var(--v${role ? 2 : 1})`).style("fill-opacity", part.name === "body" ? 0.18 : 0.55).style("stroke", `var(--v${role ? 2 : 1})`).style("stroke-width", 0.03);
    });
    car.append("text").attr("transform", `rotate(${-degrees(p[2])}) scale(1,-1)`).attr("text-anchor", "middle").attr("dy", "0.35em").style("font-size", "0.7px").style("font-weight", 600).text(v.role);
  });
  svg.append("text").attr("x", 8).attr("y", 18).text(`${fixed(run.times_ms[frameNumber], 0)} ms`);
}

function gallery() {
  const parent = document.getElementById("gallery");
  parent.textContent = "";
  const shown = data.gallery.filter(e => state.variants.has(indexOf(e.variant)) && (state.scenario === "" || e.scenario === state.scenario) &&
    (state.crashType === "" || e.crash_type === state.crashType) && (state.scope === "all" || e.inside));
  if (shown.length === 0) element(parent, "p", "No crash of the gallery is in this selection.", { class: "empty" });
  const firstFrames = [];
  shown.forEach(entry => {
    const card = element(parent, "article", undefined, { class: "card crash" });
    card.style.setProperty("--colour", colour(indexOf(entry.variant)));
    element(card, "h3", `${entry.variant}: ${entry.why}`);
    element(card, "p", `${readable(entry.scenario)}, ${entry.crash_type}, crash ${entry.crash_id}${missing(entry.olc_g) ? "" : `, OLC ${fixed(entry.olc_g, 1)} g`}, ${entry.inside ? "inside the validated range" : "outside the validated range: extrapolated"}`, { class: "note" });
    if (!entry.run) { element(card, "p", `Could not be simulated again: ${entry.failed}`, { class: "warning" }); return; }
    const run = entry.run, area = element(card, "div", undefined, { class: "area" }), controls = element(card, "div", undefined, { class: "player" });
    const button = element(controls, "button", "Play", { type: "button", "aria-label": `Play crash ${entry.crash_id}` });
    const slider = element(controls, "input", undefined, { type: "range", min: 0, max: run.times_ms.length - 1, value: 0, "aria-label": `Time in crash ${entry.crash_id}` });
    element(card, "p", `${fixed(run.closing_speed_km_h, 0)} km/h closing, offset ${fixed(run.offset_mm, 0)} mm, angle ${fixed(run.angle_deg, 0)}°. ` + run.vehicles.map(v => `${v.role}: ${readable(v.name)}, delta-v ${fixed(v.severity.delta_v_km_h, 0)} km/h, ${v.severity.olc_status === "value" ? `OLC ${fixed(v.severity.olc_g, 1)} g` : readable(v.severity.olc_status)}`).join("; ") + `. Simulated again when the report was made: ${entry.match}.`, { class: "note" });
    let timer = null;
    const show = k => { slider.value = k; drawCrash(area, run, k); };
    const stop = () => { if (timer) timer.stop(); timer = null; button.textContent = "Play"; };
    slider.oninput = () => { stop(); show(Number(slider.value)); };
    button.onclick = () => {
      if (timer) { stop(); return; }
      let k = Number(slider.value) >= run.times_ms.length - 1 ? 0 : Number(slider.value);
      button.textContent = "Stop";
      timer = d3.interval(() => { if (k >= run.times_ms.length - 1) stop(); else show(++k); }, 70);
    };
    firstFrames.push(() => show(0));
  });
  // Cards have their width only when all of them are there.
  firstFrames.forEach(draw => draw());
}
