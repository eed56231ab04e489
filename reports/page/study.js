// SPDX-License-Identifier: GPL-3.0-or-later
// What does not change with the filters: the design, what repeats the study.

// ---- what does not change with the filters ------------------------------------------------------------

function facts(parent, pairs) {
  const list = element(parent, "dl", undefined, { class: "facts" });
  pairs.filter(p => !missing(p[1]) && p[1] !== "").forEach(p => { element(list, "dt", p[0]); element(list, "dd", p[1]); });
  return list;
}

// ---- parameters: what differs from the default or between the owners, the rest folded ------------------

// Rows {control, parameter, standard, values} over owners {name, controls: [{name, parameters, equipment}]}.
function parameterRows(owners) {
  const rows = [], names = [...new Set(owners.flatMap(o => o.controls.map(c => c.name)))];
  names.forEach(name => {
    const own = owners.map(o => o.controls.find(c => c.name === name)), defaults = ((data.controls || {})[name] || {}).parameters || {};
    const keys = [...new Set(own.flatMap(c => (c ? Object.keys(c.parameters || {}) : [])))];
    keys.forEach(key => rows.push({ control: name, parameter: key, standard: defaults[key], values: own.map(c => (c && c.parameters ? c.parameters[key] : undefined)) }));
    const types = [...new Set(own.flatMap(c => (c ? Object.keys(c.equipment || {}) : [])))];
    types.forEach(type => rows.push({ control: name, parameter: `equipment of ${type}`, standard: defaults.penetration_1, values: own.map(c => (c && c.equipment ? c.equipment[type] : undefined)) }));
  });
  return rows;
}

function differs(row) {
  const given = row.values.filter(v => v !== undefined);
  return given.some(v => v !== given[0]) || (row.standard !== undefined && given.some(v => v !== row.standard));
}

// Who has which controls, then the rows of values; "–" for an owner without the control.
function parameterTable(parent, what, owners, rows, known, caption) {
  const holder = element(parent, "div", undefined, { class: "scroll", tabindex: "0", role: "region", "aria-label": caption });
  const names = [...new Set(owners.flatMap(o => o.controls.map(c => c.name)))];
  const lines = [];
  names.forEach(name => {
    lines.push([name, ...(known ? [""] : []), ...owners.map(o => (o.controls.some(c => c.name === name) ? "yes" : "–"))]);
    rows.filter(r => r.control === name).forEach(r => lines.push([`${name}.${r.parameter}`, ...(known ? [r.standard === undefined ? "–" : String(r.standard)] : []), ...r.values.map(v => (v === undefined ? "–" : String(v)))]));
  });
  const node = table(holder, caption, [{ name: what, text: true }, ...(known ? [{ name: "default" }] : []), ...owners.map(o => ({ name: o.name }))], lines);
  // A value that is not the default stands out.
  if (known) node.querySelectorAll("tbody tr").forEach(tr => Array.from(tr.cells).slice(2).forEach(cell => {
    const standard = tr.cells[1].textContent;
    if (standard !== "" && standard !== "–" && cell.textContent !== "–") cell.classList.add(cell.textContent === standard ? "as-default" : "differs");
  }));
}

function parameters(id, what, owners) {
  const parent = document.getElementById(id), rows = parameterRows(owners), shown = rows.filter(differs), known = rows.some(r => r.standard !== undefined);
  if (!owners.some(o => o.controls.length)) { element(parent, "p", `No ${what} at all.`, { class: "note" }); return; }
  parameterTable(parent, what, owners, shown, known, `What differs from the default${owners.length > 1 ? " or between them" : ""}${rows.length > shown.length ? `; ${rows.length - shown.length} of ${rows.length} parameters do not` : ""}.`);
  if (rows.length === shown.length) return;
  const details = element(parent, "details");
  element(details, "summary", `All ${rows.length} parameters`);
  parameterTable(details, what, owners, rows, known, `All parameters of every ${what}`);
}

function design() {
  const parent = document.getElementById("design"), study = data.study;
  const words = { paired_seeds: "paired seeds: every variant runs the same demand and seeds, replications are compared pair by pair", independent: "independent: every variant has its own seeds", counterfactual: "counterfactual: every crash of the baseline is run again from a checkpoint before contact, with each treatment and once unchanged" };
  facts(parent, [
    ["Design", words[study.design] || study.design],
    ["Replications", `${study.replications} planned per scenario and variant${data.unfinished ? `; ${data.unfinished} not finished and not counted` : ""}`],
    ["Simulated", `${study.duration_s} s each, of these ${study.warmup_s} s warm-up not counted; step ${study.step_length_s} s`],
    ...data.backgrounds.map(b => [`Without driver errors, ${b.scenario}`, b.is_known ? b.text + ": the network’s own doing" : "not simulated"]),
    ["Observation", "the frontally struck vehicle; a crash with both fronts struck gives two, kept together with all crashes of their replication in every interval and test"]
  ]);
  parameters("parameters-functions", "function", data.variants.map(v => ({ name: v.name, controls: v.functions.map(f => Object.assign({ name: f.function }, f)) })));
  parameters("parameters-errors", "driver error", data.about.scenarios.map(s => ({ name: s.name, controls: JSON.parse(s.driver_errors).map(e => Object.assign({ name: e.model }, e)) })));
  data.caveats.forEach(text => element(parent, "p", `Mind: ${text}.`, { class: "warning" }));
  data.backgrounds.filter(b => b.warning).forEach(b => element(parent, "p", `Mind: ${b.warning}.`, { class: "warning" }));
  document.getElementById("note-contrasts").textContent = study.design === "counterfactual" ?
    "p by sign flips of whole replications; intervals by bootstrap over replications (BCa), given from 20 replications on, and of shares by counts widened by what replications scatter. Hodges–Lehmann: the median of all means of two changes. Holm’s adjustment covers every p of the table." :
    `Rate: p by ${study.design === "paired_seeds" ? "sign flips of whole seed pairs" : "permutation of whole replications"}, interval by bootstrap over replications or, with fewer than 20 of them, of Poisson counts widened by what they scatter. Severity: Cliff’s δ, the chance that a vehicle of the treatment has the higher OLC minus the chance that it has the lower one, with a test and an interval from its own scatter over replications, which hold when one variant crashes more often; scenarios are compared within themselves. “95 %, unknown outside”: what is left of the interval when severities outside the validated range count as unknown. Holm’s adjustment covers every p of the comparison.`;
}

// ---- assessment record ---------------------------------------------------------------------------------

const among = (n, of, what) => `${integer(n)} of ${integer(of)} ${what}`;

// What the program knows of an item; nothing of what only a person can say.
function knownOf(key) {
  const s = data.slices[0], errors = [...new Set(data.about.scenarios.flatMap(x => JSON.parse(x.driver_errors).map(e => e.model)))], functions = [...new Set(data.variants.flatMap(v => v.functions.map(f => f.function)))];
  const words = (list, none) => (list.length ? list.join(", ") : none), baseline = s.variants.find(v => v.is_baseline);
  const frontal = d3.sum(s.variants, v => v.frontal_vehicles), inside = d3.sum(s.variants, v => v.inside_validity), sets = [s.variants, s.contrasts, s.counterfactual].flat().filter(v => v.model_uncertainty).length;
  const judgedRows = scorecard.filter(r => r.result === "kept" || r.result === "missed"), kept = judgedRows.filter(r => r.result === "kept").length;
  switch (key) {
    case "baseline": return `Synthetic: crashes arise in simulated traffic from assumed driver errors; none is a recorded one. ${baseline ? `${baseline.variant}: ${words((data.variants.find(v => v.name === baseline.variant) || { functions: [] }).functions.map(f => f.function), "no function")}, ${integer(Math.round(baseline.vehicle_km))} vehicle-km.` : ""}`;
    case "technology": return `${words(functions, "No function")} in ${words(data.variants.filter(v => !v.is_baseline).map(v => v.name), "no treatment")}; parameters under study design.`;
    case "input_data": return `Networks and demand of ${words([...new Set(data.about.scenarios.map(x => x.sumocfg))], "–")}; not calibrated by this program.`;
    case "driver_behaviour": return `SUMO’s driver, and assumed errors: ${words(errors, "none")}. Drivers do not adapt to the functions. ${data.backgrounds.map(b => `Without errors, ${b.scenario}: ${b.is_known ? b.text : "not simulated"}`).join(". ")}`;
    case "validation": return `Crash model: ${among(kept, judgedRows.length, "bars kept beside real crash tests by the shipped vehicles")} (scorecard); ${among(inside, frontal, "frontally struck vehicles inside its validated range")}. Traffic: ${data.about.sumo_collision_check.length ? `${integer(d3.sum(data.about.sumo_collision_check, c => c.unexplained))} of SUMO’s ${integer(d3.sum(data.about.sumo_collision_check, c => c.reported_by_sumo))} reported collisions unexplained` : "SUMO’s collision reports not stored"}.`;
    case "metrics": return `Frontal crashes per vehicle-km, crashes above ${s.variants[0].crashes_above.olc.x} g, OLC, delta-v, closing speed; expected injured drivers by ${words([...new Set(data.risks.map(r => r.name))], "no risk function")}.`;
    case "projection": return "None: figures are of the simulated traffic, weighted to no population.";
    case "negative_effects": return PAIRS ? s.counterfactual.map(c => `${c.variant}: ${among(c.outcomes.aggravated, c.valid, "crashes aggravated")}, ${integer(c.new_crashes)} new ones between others`).join("; ") + "."
      : "New crashes of a treatment count in its rate; " + s.contrasts.map(c => `${c.variant} ${integer(c.frontal_crashes[1])} against ${integer(c.frontal_crashes[0])} frontal crashes`).join(", ") + ".";
    case "uncertainties": return `Intervals over ${s.variants.map(v => `${integer(v.replications)} replications of ${v.variant}`).join(", ")}; severities outside the validated range in bounds; the crash model’s own ${sets ? "from the ensembles of its vehicle models" : "not estimated: no ensemble"}.`;
    case "sensitivity": return parametersSwept.length ? `Swept: ${parametersSwept.map(p => p.parameter).join(", ")}.` : "No parameter is swept in this study.";
    case "limitations": return "“What these numbers are not”, above.";
    default: return "–";
  }
}

const assessmentTable = tableSection("assessment", null, function () {
  const items = [{ key: "question", title: "Research question", says: "what is asked", text: data.study.question, place: "question" }, ...data.assessment];
  const left = items.filter(i => !i.text);
  document.getElementById("assessment-missing").textContent = left.length ? `Missing: ${left.length} of ${items.length} (${left.map(i => i.title.toLowerCase()).join(", ")}).` : "Nothing is missing.";
  return {
    columns: [{ name: "step", text: true }, { name: "said by the author", text: true }, { name: "known to the program", text: true }],
    rows: items.map(i => [i.title, i.text || `missing: ${i.place || `assessment.${i.key}`}, ${i.says}`, knownOf(i.key)])
  };
});

function assessment() {
  assessmentTable();
  document.querySelectorAll("#table-assessment td").forEach(cell => cell.classList.toggle("missing", cell.textContent.startsWith("missing: ")));
}

function reproduce() {
  const parent = document.getElementById("reproduce"), about = data.about, study = data.study;
  facts(parent, [
    ["Study file", `${study.name}, SHA-256 ${study.hash}`],
    ["Study seed", data.sample.seed],
    ["Programs", about.versions.map(v => `crashpulse ${v.crashpulse_version}, SUMO ${v.sumo_version} (${v.replications} replications)`).join("; ")],
    ["Vehicle models", about.vehicle_models.map(m => `${m.name}, SHA-256 ${m.hash}`).join("; ")],
    ["Scenarios", about.scenarios.map(s => s.sumocfg).join(", ")],
    ["SUMO’s own reports", about.sumo_collision_check.map(c => `${c.scenario} / ${c.variant}: ${c.reported_by_sumo} colliding pairs, ${c.matched} found as crashes, ${c.explained} explained, ${c.apart ? `${c.apart} with outlines ${c.apart_min_m.toFixed(2)} to ${c.apart_max_m.toFixed(2)} m apart, ` : ""}${c.unexplained} unexplained`).join("; ")]
  ]);
  const seeds = element(parent, "details");
  element(seeds, "summary", `Seeds and configuration hashes of ${about.replications.length} replications`);
  const holder = element(seeds, "div", undefined, { class: "scroll limits-height", tabindex: "0", role: "region", "aria-label": "Seeds and hashes" });
  table(holder, "", ["scenario", "variant", "number", "seed", "status", "configuration_hash"].map(name => ({ name: readable(name), text: true })),
    about.replications.map(r => [r.scenario, r.variant + (r.sweep ? ` [${r.sweep}]` : ""), r.number, r.seed, r.status, r.configuration_hash]));
  const yaml = element(parent, "details");
  element(yaml, "summary", "The study file");
  element(yaml, "pre", study.yaml);
  data.queries.forEach(q => sqlDetails(document.getElementById("queries"), q.name));
}
