// SPDX-License-Identifier: GPL-3.0-or-later
// What does not change with the filters: the design, what repeats the study.

// ---- what does not change with the filters ------------------------------------------------------------

function facts(parent, pairs) {
  const list = element(parent, "dl", undefined, { class: "facts" });
  pairs.filter(p => !missing(p[1]) && p[1] !== "").forEach(p => { element(list, "dt", p[0]); element(list, "dd", p[1]); });
  return list;
}

const settingsText = (object, between) => Object.keys(object || {}).map(name => `${name}${between}${object[name]}`).join(", ");
const control = c => `${c.model || c.function} (${settingsText(c.parameters, " = ")}${c.equipment ? `; equipment ${settingsText(c.equipment, " ")}` : ""})`;

function design() {
  const parent = document.getElementById("design"), study = data.study;
  const words = { paired_seeds: "paired seeds: every variant runs the same demand and seeds, replications are compared pair by pair", independent: "independent: every variant has its own seeds", counterfactual: "counterfactual: every crash of the baseline is run again from a checkpoint before contact, with each treatment and once unchanged" };
  facts(parent, [
    ["Design", words[study.design] || study.design],
    ["Replications", `${study.replications} planned per scenario and variant${data.unfinished ? `; ${data.unfinished} not finished and not counted` : ""}`],
    ["Simulated", `${study.duration_s} s each, of these ${study.warmup_s} s warm-up not counted; step ${study.step_length_s} s`],
    ...data.about.scenarios.map(s => [`Driver errors in ${s.name}`, JSON.parse(s.driver_errors).map(control).join("; ") || "none"]),
    ...data.variants.map(v => [`Variant ${v.name}`, v.functions.map(control).join("; ") || "no function"]),
    ...data.backgrounds.map(b => [`Without driver errors, ${b.scenario}`, b.is_known ? b.text + ": the network’s own doing" : "not simulated"]),
    ["Observation", "the frontally struck vehicle; a crash with both fronts struck gives two, kept together with all crashes of their replication in every interval and test"]
  ]);
  data.caveats.forEach(text => element(parent, "p", `Mind: ${text}.`, { class: "warning" }));
  data.backgrounds.filter(b => b.warning).forEach(b => element(parent, "p", `Mind: ${b.warning}.`, { class: "warning" }));
  document.getElementById("note-contrasts").textContent = study.design === "counterfactual" ?
    "p by sign flips of whole replications; intervals by bootstrap over replications (BCa), given from 20 replications on, and of shares by counts widened by what replications scatter. Hodges–Lehmann: the median of all means of two changes. Holm’s adjustment covers every p of the table." :
    `Rate: p by ${study.design === "paired_seeds" ? "sign flips of whole seed pairs" : "permutation of whole replications"}, interval by bootstrap over replications or, with fewer than 20 of them, of Poisson counts widened by what they scatter. Severity: Cliff’s δ, the chance that a vehicle of the treatment has the higher OLC minus the chance that it has the lower one, with a test and an interval from its own scatter over replications, which hold when one variant crashes more often; scenarios are compared within themselves. “95 %, unknown outside”: what is left of the interval when severities outside the validated range count as unknown. Holm’s adjustment covers every p of the comparison.`;
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
