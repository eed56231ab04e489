// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = id => document.getElementById(id);
  const missing = value => value === null || value === undefined;
  const fixed = (value, digits) => missing(value) ? "–" : value.toFixed(digits).replace(/^-(?=[0.]*$)/, "").replace("-", "−");
  const readable = text => text.replace(/_/g, " ").replace(/,/g, ", ");

  // Every vehicle of every run is one series: own colour, the overlay dashed.
  const series = d3.merge(data.runs.map((run, r) => run.vehicles.map((vehicle, c) =>
    ({ run: run, over: r > 0, vehicle: vehicle, colour: `var(--c${2 * r + c})` }))));
  series.forEach(s => {
    const where = s.run.barrier ? "against the barrier" : `${s.vehicle.role}, car to car`;
    s.label = series.length > 1 ? `${s.vehicle.name} (${where}${s.over ? ", overlay" : ""})` : s.vehicle.name;
  });
  const duration = d3.max(data.runs, run => d3.max(run.vehicles, v => v.pulse.interval_ms * (v.pulse.a_g.length - 1)));
  const state = { t: 0, playing: false, overlay: true };
  const shown = () => series.filter(s => state.overlay || !s.over);

  function element(parent, tag, text, attributes) {
    const node = document.createElement(tag);
    if (text !== undefined) node.textContent = text;
    for (const name in attributes || {}) node.setAttribute(name, attributes[name]);
    parent.appendChild(node);
    return node;
  }

  // ---- values at a time -----------------------------------------------------------------------

  // Place of t among equally or otherwise spaced times: index and share of the way to the next.
  function place(times, t) {
    const k = Math.max(0, Math.min(times.length - 2, d3.bisectRight(times, t) - 1));
    if (times.length < 2) return { k: 0, next: 0, share: 0 };
    return { k: k, next: k + 1, share: Math.max(0, Math.min(1, (t - times[k]) / (times[k + 1] - times[k]))) };
  }

  const between = (a, b, share) => a + (b - a) * share;
  const turned = (a, b, share) => a + Math.atan2(Math.sin(b - a), Math.cos(b - a)) * share;

  function poseAt(list, at) {
    const a = list[at.k], b = list[at.next];
    return { x: between(a[0], b[0], at.share), y: between(a[1], b[1], at.share), yaw: turned(a[2], b[2], at.share), length: a.length > 3 ? between(a[3], b[3], at.share) : 0 };
  }

  function pulseAt(s, channel, t) {
    const values = s.vehicle.pulse[channel], where = t / s.vehicle.pulse.interval_ms;
    const k = Math.min(values.length - 1, Math.floor(where)), next = Math.min(values.length - 1, k + 1);
    return between(values[k], values[next], where - Math.floor(where));
  }

  // ---- the scene --------------------------------------------------------------------------------

  const KIND = name => name.replace(/_(left|right)$/, "");
  // From below to above: what collapses slides under the body.
  const LAYERS = ["upper", "corner", "engine", "longitudinal", "crash_box", "body", "cross_member"];
  const crushed = d3.scaleSequential(d3.interpolateYlOrRd).domain([-0.15, 0.95]).clamp(true);
  const degrees = rad => rad * 180 / Math.PI;
  const scene = { svg: null, world: null, cars: [] };

  // All that is ever seen, from above, m; fronts: about the first contact.
  function extent(front) {
    const first = data.runs[0].vehicles[0];
    if (front) return { x: [first.cg_to_front_m - 1.9, first.cg_to_front_m + 1.9], y: [-1.12, 1.12] };
    const xs = [], ys = [];
    data.runs.forEach(run => {
      if (run.barrier) {
        const b = run.barrier, c = Math.cos(b.yaw_rad), n = Math.sin(b.yaw_rad);
        [[-1, -1], [-1, 1], [1, -1], [1, 1]].forEach(corner => {
          xs.push(b.x_m + corner[0] * b.length_m / 2 * c - corner[1] * b.width_m / 2 * n);
          ys.push(b.y_m + corner[0] * b.length_m / 2 * n + corner[1] * b.width_m / 2 * c);
        });
      }
      run.vehicles.forEach(v => v.poses.forEach(p => {
        const front_m = v.cg_to_front_m, rear_m = front_m - v.length_m, w = v.width_m / 2;
        [[front_m, w], [front_m, -w], [rear_m, w], [rear_m, -w]].forEach(q => {
          xs.push(p[0] + q[0] * Math.cos(p[2]) - q[1] * Math.sin(p[2]));
          ys.push(p[1] + q[0] * Math.sin(p[2]) + q[1] * Math.cos(p[2]));
        });
      }));
    });
    return { x: d3.extent(xs), y: d3.extent(ys) };
  }

  function drawCar(parent, s, index) {
    const v = s.vehicle;
    const car = parent.append("g").attr("class", s.over ? "car over" : "car").attr("data-series", index).style("--colour", s.colour);
    car.append("rect").attr("class", "was").attr("x", v.cg_to_front_m - v.length_m).attr("y", -v.width_m / 2)
      .attr("width", v.length_m).attr("height", v.width_m).attr("rx", 0.06);
    const parts = v.parts.slice().sort((a, b) => LAYERS.indexOf(KIND(a.name)) - LAYERS.indexOf(KIND(b.name)));
    const nodes = parts.map(part => ({
      part: part,
      node: car.append("rect").attr("class", `part ${KIND(part.name)}`).attr("data-part", part.name)
        .attr("rx", part.radius_m).attr("y", -part.width_m / 2).attr("height", part.width_m)
    }));
    // Centre of gravity and the way ahead.
    car.append("path").attr("class", "ahead").attr("d", "M0.22,0H0.75M0.62,0.07L0.75,0L0.62,-0.07");
    car.append("circle").attr("class", "cog-ring").attr("r", 0.11);
    car.append("path").attr("class", "cog-quarter").attr("d", "M0,0L0.11,0A0.11,0.11 0 0 1 0,0.11ZM0,0L-0.11,0A0.11,0.11 0 0 1 0,-0.11Z");
    return { series: s, car: car, nodes: nodes };
  }

  function drawWall(parent, run) {
    const b = run.barrier;
    parent.append("rect").attr("class", "wall").attr("rx", b.radius_m)
      .attr("x", -b.length_m / 2).attr("y", -b.width_m / 2).attr("width", b.length_m).attr("height", b.width_m)
      .attr("transform", `translate(${b.x_m},${b.y_m}) rotate(${degrees(b.yaw_rad)})`);
  }

  function ground(world, x, y) {
    const lines = world.append("g").attr("class", "ground");
    d3.range(Math.floor(x[0]), Math.ceil(x[1]) + 1).forEach(k => lines.append("line").attr("x1", k).attr("x2", k).attr("y1", y[0]).attr("y2", y[1]));
    d3.range(Math.floor(y[0]), Math.ceil(y[1]) + 1).forEach(k => lines.append("line").attr("y1", k).attr("y2", k).attr("x1", x[0]).attr("x2", x[1]));
  }

  function drawScene() {
    const area = byId("scene");
    area.textContent = "";
    const width = Math.max(300, area.clientWidth), margin = 14;
    const whole = extent(false), fronts = extent(true);
    const tallest = Math.max(200, Math.min(500, Math.max(0.36 * width, 260), 0.5 * window.innerHeight));
    const scaleFor = box => Math.min((width - 2 * margin) / (box.x[1] - box.x[0]), (tallest - 2 * margin) / (box.y[1] - box.y[0]));
    const useful = scaleFor(fronts) > 1.2 * scaleFor(whole);
    byId("view-label").hidden = !useful;
    const box = useful && byId("view").value === "front" ? fronts : whole, scale = scaleFor(box);
    const height = Math.max(180, Math.min(tallest, scale * (box.y[1] - box.y[0]) + 2 * margin + 26));
    const middle = [(box.x[0] + box.x[1]) / 2, (box.y[0] + box.y[1]) / 2];
    const svg = d3.select(area).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height)
      .attr("role", "img").attr("aria-label", `The crash from above. ${byId("setting").textContent}`);
    const hatch = svg.append("defs").append("pattern").attr("id", "hatch").attr("patternUnits", "userSpaceOnUse").attr("width", 0.16).attr("height", 0.16).attr("patternTransform", "rotate(45)");
    hatch.append("rect").attr("width", 0.16).attr("height", 0.16);
    hatch.append("line").attr("y2", 0.16);
    const world = svg.append("g").attr("transform", `translate(${width / 2},${height / 2}) scale(${scale},${-scale}) translate(${-middle[0]},${-middle[1]})`);
    const half = [width / 2 / scale, height / 2 / scale];
    ground(world, [middle[0] - half[0], middle[0] + half[0]], [middle[1] - half[1], middle[1] + half[1]]);
    data.runs.forEach((run, r) => { if (run.barrier && (r === 0 || (state.overlay && !data.runs[0].barrier))) drawWall(world, run); });
    scene.cars = shown().map(s => drawCar(world, s, series.indexOf(s)));
    scene.stamp = svg.append("text").attr("class", "stamp").attr("x", 14).attr("y", 28);
    svg.append("text").attr("x", width - 12).attr("y", height - 10).attr("text-anchor", "end").text("grid 1 m");
  }

  function moveScene() {
    scene.cars.forEach(c => {
      const at = place(c.series.run.times_ms, state.t), pose = poseAt(c.series.vehicle.poses, at);
      c.car.attr("transform", `translate(${pose.x},${pose.y}) rotate(${degrees(pose.yaw)})`);
      c.nodes.forEach(n => {
        const p = poseAt(n.part.frames, at);
        n.node.attr("transform", `translate(${p.x},${p.y}) rotate(${degrees(p.yaw)})`).attr("x", -p.length / 2).attr("width", p.length);
        const kind = KIND(n.part.name);
        if (!c.series.over && (kind === "longitudinal" || kind === "crash_box"))
          n.node.style("fill", crushed(1 - p.length / n.part.frames[0][3]));
      });
    });
    scene.stamp.text(`${fixed(state.t, 1)} ms`);
  }

  // ---- curves -----------------------------------------------------------------------------------

  const CHARTS = [
    { id: "chart-a", title: "a(t)", unit: "g", about: "acceleration, CFC60", x: null, y: "a_g" },
    { id: "chart-v", title: "v(t)", unit: "km/h", about: "velocity", x: null, y: "v_km_h", occupant: true },
    { id: "chart-s", title: "s(t)", unit: "mm", about: "displacement", x: null, y: "s_mm" },
    { id: "chart-as", title: "a(s)", unit: "g", about: "acceleration over displacement", x: "s_mm", y: "a_g" }
  ];

  // The virtual occupant: v0 to t1, then evenly slower to t2.
  function occupant(s) {
    const own = s.vehicle.severity;
    if (own.olc_status !== "value") return null;
    const v0 = s.vehicle.pulse.v_km_h[0], end = v0 - own.olc_g * 9.80665 * (own.olc_t2_ms - own.olc_t1_ms) / 1000 * 3.6;
    return [[0, v0], [own.olc_t1_ms, v0], [own.olc_t2_ms, end]];
  }

  const points = (s, chart) => s.vehicle.pulse[chart.y].map((y, k) => [chart.x ? s.vehicle.pulse[chart.x][k] : k * s.vehicle.pulse.interval_ms, y]);

  function drawChart(chart) {
    const node = byId(chart.id);
    node.textContent = "";
    const caption = element(node, "figcaption", chart.title + " ");
    element(caption, "small", chart.about);
    const area = element(node, "div"), width = Math.max(220, area.clientWidth), height = 236;
    const margin = { top: 10, right: 12, bottom: 38, left: 48 }, w = width - margin.left - margin.right, h = height - margin.top - margin.bottom;
    // Scales of all series, so that hiding the overlay moves nothing.
    const all = d3.merge(series.map(s => points(s, chart)));
    const xs = chart.x ? d3.extent(all, p => p[0]) : [0, duration];
    const ys = d3.extent(all, p => p[1]);
    const x = d3.scaleLinear().domain([Math.min(0, xs[0]), xs[1]]).range([0, w]);
    const y = d3.scaleLinear().domain([Math.min(0, ys[0]), Math.max(0, ys[1])]).nice().range([h, 0]);
    const svg = d3.select(area).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height).attr("role", "img")
      .attr("aria-label", `${chart.about}, ${chart.unit}, ${chart.x ? "over displacement, mm" : "over time, ms"}: ` + shown().map(s => `${s.label} from ${fixed(d3.min(points(s, chart), p => p[1]), 1)} to ${fixed(d3.max(points(s, chart), p => p[1]), 1)}`).join("; "));
    const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    inner.selectAll(null).data(y.ticks(5)).enter().append("line").attr("class", "gridline").attr("x2", w).attr("y1", y).attr("y2", y);
    inner.append("line").attr("class", "zero").attr("x2", w).attr("y1", y(0)).attr("y2", y(0));
    const minus = value => d3.format(",")(value).replace(/,/g, " ").replace("-", "−");
    inner.append("g").attr("class", "axis").attr("transform", `translate(0,${h})`).call(d3.axisBottom(x).ticks(Math.max(3, w / 60)).tickFormat(minus).tickSizeOuter(0));
    inner.append("g").attr("class", "axis").call(d3.axisLeft(y).ticks(5).tickFormat(minus).tickSizeOuter(0));
    inner.append("text").attr("class", "soft").attr("x", w).attr("y", h + 33).attr("text-anchor", "end").text(chart.x ? "s, mm" : "t, ms");
    inner.append("text").attr("class", "soft").attr("x", -margin.left + 2).attr("y", h + 33).text(`${chart.title[0]}, ${chart.unit}`);
    const line = d3.line().x(p => x(p[0])).y(p => y(p[1]));
    chart.dots = shown().map(s => {
      const values = points(s, chart), cls = s.over ? "curve over" : "curve";
      inner.append("path").attr("class", cls).style("--colour", s.colour).attr("d", line(values));
      if (chart.occupant && occupant(s))
        inner.append("path").attr("class", "occupant").style("--colour", s.colour).attr("d", line(occupant(s)));
      return { series: s, dot: null };
    });
    chart.cursor = chart.x ? null : inner.append("line").attr("class", "cursor").attr("y2", h);
    chart.dots.forEach(d => { d.dot = inner.append("circle").attr("class", "dot").attr("r", 4.5).style("--colour", d.series.colour); });
    chart.scales = { x: x, y: y };
    if (!chart.x) timeByPointer(svg.classed("timed", true), x, margin.left);
  }

  function timeByPointer(svg, x, left) {
    const node = svg.node();
    const go = event => {
      const box = node.getBoundingClientRect(), scale = node.viewBox.baseVal.width / box.width;
      pause();
      setTime(x.invert((event.clientX - box.left) * scale - left));
    };
    node.addEventListener("pointerdown", event => { node.setPointerCapture(event.pointerId); go(event); });
    node.addEventListener("pointermove", event => { if (event.buttons & 1) go(event); });
  }

  function moveCharts() {
    CHARTS.forEach(chart => {
      if (chart.cursor) chart.cursor.attr("x1", chart.scales.x(state.t)).attr("x2", chart.scales.x(state.t));
      chart.dots.forEach(d => d.dot.attr("cx", chart.scales.x(chart.x ? pulseAt(d.series, chart.x, state.t) : state.t))
        .attr("cy", chart.scales.y(pulseAt(d.series, chart.y, state.t))));
    });
  }

  // ---- numbers and legend -----------------------------------------------------------------------

  const STATUS = { value: "", not_front_contact: "not struck in front", no_deceleration: "too little deceleration", beyond_0_5_s: "later than 0.5 s", simulation_failed: "failed" };
  const live = [];

  function numbers() {
    const node = element(byId("numbers"), "table");
    const columns = ["vehicle", "struck on its", "OLC, g", "delta-v, km/h", "peak, g", "t(v = 0), ms", "crush, mm", "a now, g", "v now, km/h", "s now, mm"];
    const head = element(element(node, "thead"), "tr");
    columns.forEach((c, k) => element(head, "th", c, k < 2 ? { scope: "col", class: "text" } : { scope: "col" }));
    const body = element(node, "tbody");
    series.forEach(s => {
      const own = s.vehicle.severity, row = element(body, "tr");
      const name = element(row, "th", undefined, { scope: "row" });
      element(name, "span", undefined, { class: "swatch" }).style.setProperty("--colour", s.colour);
      name.appendChild(document.createTextNode(s.label));
      element(row, "td", own.contact_side, { class: "text" });
      element(row, "td", own.olc_status === "value" ? fixed(own.olc_g, 1) : STATUS[own.olc_status]);
      [fixed(own.delta_v_km_h, 1), fixed(own.peak_g, 1), fixed(own.t_v0_ms, 1), fixed(own.crush_mm, 0)].forEach(text => element(row, "td", text));
      live.push({ series: s, cells: ["a_g", "v_km_h", "s_mm"].map(channel => ({ channel: channel, node: element(row, "td") })) });
    });
    byId("trust").textContent = series.map(s => {
      const outside = s.vehicle.severity.validity;
      return `${s.label}: ${outside === "inside" ? "inside the range its model was calibrated in" : `extrapolated: outside by ${readable(outside).replace(/\bmodel$/, "its model, which was never calibrated here")}`}.`;
    }).join(" ");
  }

  function moveNumbers() {
    live.forEach(row => row.cells.forEach(cell => { cell.node.textContent = fixed(pulseAt(row.series, cell.channel, state.t), cell.channel === "s_mm" ? 0 : 1); }));
  }

  function legend() {
    const parent = byId("legend");
    parent.textContent = "";
    shown().forEach(s => {
      const entry = element(parent, "span", undefined, { class: "entry" });
      const mark = d3.select(entry).append("svg").attr("width", 30).attr("height", 12).attr("aria-hidden", "true");
      mark.append("line").attr("x2", 30).attr("y1", 6).attr("y2", 6).style("stroke", s.colour).style("stroke-width", 3).style("stroke-dasharray", s.over ? "6 3" : null);
      element(entry, "span", s.label);
    });
    const scale = element(parent, "span", undefined, { class: "entry scale" });
    element(scale, "span", "longitudinals, crash boxes: undeformed");
    const bar = d3.select(scale).append("svg").attr("width", 90).attr("height", 12).attr("aria-hidden", "true");
    d3.range(30).forEach(k => bar.append("rect").attr("x", 3 * k).attr("width", 3.2).attr("height", 12).style("fill", crushed(0.8 * k / 29)));
    element(scale, "span", "80 % shorter");
  }

  function setting() {
    const words = data.runs.map(run => {
      const opponent = run.barrier ? "a rigid barrier" : `${run.against} at ${fixed(run.opponent_speed_km_h, 0)} km/h`;
      return `${run.vehicle} at ${fixed(run.speed_km_h, 0)} km/h against ${opponent}`;
    });
    const run = data.runs[0];
    const place = `offset ${fixed(run.offset_mm, 0)} mm, angle ${fixed(run.angle_deg, 0)}°` + (missing(run.overlap_1) ? "" : `, overlap ${fixed(100 * run.overlap_1, 0)} %`) + `, closing speed ${fixed(run.closing_speed_km_h, 0)} km/h`;
    byId("setting").textContent = words.length > 1 ? `${place}. Overlay, dashed: ${words[1]}.` : `${place}.`;
  }

  // ---- time ---------------------------------------------------------------------------------------

  function setTime(t) {
    state.t = Math.max(0, Math.min(duration, t));
    const slider = byId("time");
    slider.value = state.t;
    slider.setAttribute("aria-valuetext", `${fixed(state.t, 1)} milliseconds`);
    byId("clock").textContent = `${fixed(state.t, 1)} ms`;
    moveScene();
    moveCharts();
    moveNumbers();
  }

  // One frame of playing; real time passes times slower than it is shown.
  function tick(now) {
    if (!state.playing) return;
    const slower = Number(byId("speed").value);
    const t = state.t + (now - state.last) / slower;
    state.last = now;
    if (t >= duration) {
      setTime(duration);
      pause();
      return;
    }
    setTime(t);
    requestAnimationFrame(tick);
  }

  function play() {
    if (state.t >= duration) setTime(0);
    state.playing = true;
    state.last = performance.now();
    byId("play").textContent = "Pause";
    requestAnimationFrame(tick);
  }

  function pause() {
    state.playing = false;
    byId("play").textContent = "Play";
  }

  // ---- putting it together ---------------------------------------------------------------------

  function draw() {
    legend();
    drawScene();
    CHARTS.forEach(drawChart);
    setTime(state.t);
  }

  function theme(dark) {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    const button = byId("theme");
    button.textContent = dark ? "Light" : "Dark";
    button.setAttribute("aria-pressed", String(dark));
    button.setAttribute("aria-label", dark ? "Switch to light colours" : "Switch to dark colours");
  }

  [[10, "1/10"], [20, "1/20"], [50, "1/50"], [100, "1/100"]].forEach(s => element(byId("speed"), "option", s[1], { value: s[0] }));
  byId("speed").value = "50";
  byId("time").max = duration;
  byId("time").oninput = event => { pause(); setTime(Number(event.target.value)); };
  byId("play").onclick = () => state.playing ? pause() : play();
  byId("view").onchange = draw;
  byId("overlay-label").hidden = data.runs.length < 2;
  byId("overlay").onchange = event => { state.overlay = event.target.checked; draw(); };
  document.addEventListener("keydown", event => {
    if (event.key !== " " || /^(BUTTON|SELECT|A|TEXTAREA|SUMMARY)$/.test(event.target.tagName) || event.target.type === "checkbox") return;
    event.preventDefault();
    byId("play").click();
  });
  const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
  theme(prefersDark.matches);
  prefersDark.onchange = event => theme(event.matches);
  byId("theme").onclick = () => theme(document.documentElement.dataset.theme !== "dark");
  let width = window.innerWidth, pending = 0;
  window.addEventListener("resize", () => {
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    cancelAnimationFrame(pending);
    pending = requestAnimationFrame(draw);
  });
  // Address with #t=100: the moment of 100 ms; #t=100&view=front: of the fronts.
  function goToFragment() {
    const wanted = new URLSearchParams(window.location.hash.slice(1)), t = Number(wanted.get("t"));
    if (wanted.get("view") === "front" || wanted.get("view") === "whole") byId("view").value = wanted.get("view");
    if (wanted.has("t") && Number.isFinite(t)) { pause(); state.t = Math.max(0, Math.min(duration, t)); }
  }
  window.addEventListener("hashchange", () => { goToFragment(); draw(); });
  goToFragment();
  setting();
  numbers();
  draw();
})();
