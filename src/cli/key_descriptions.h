/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_KEY_DESCRIPTIONS_H
#define CLI_KEY_DESCRIPTIONS_H

/* What every key of a YAML file means: 'crashpulse reference' puts it beside what the schemas say,
 * and a test sees that none is missing. X(path in the schema, values and default, what it is). */

#define CP_STUDY_KEYS(X)                                                                           \
    X("study", "1 to 64 letters, digits, _ - .", "name of the study")                              \
    X("question", "", "what it is to answer; on the report")                                       \
    X("design", "paired_seeds, independent, counterfactual",                                       \
      "whether variants share traffic and errors; or every baseline crash again, from seconds "    \
      "before it")                                                                                 \
    X("baseline", "a variant; default: the first", "what the others are compared with")            \
    X("seed", "0 to 2^53", "of all random draws: same seed, same results")                         \
    X("replications", "1 to 1000000", "runs of every scenario with every variant")                 \
    X("duration_s", "above 0 to 1000000", "simulated time of a run, the warm-up included")         \
    X("warmup_s", "default 0; less than duration_s", "not counted: the network fills")             \
    X("step_length_s", "0.001 to 1, whole milliseconds; default 0.05", "step of SUMO")             \
    X("history_s", "0 to 60; default 0", "how much of both cars before each crash is kept")        \
    X("after_crash", "", "what becomes of crashed cars")                                           \
    X("after_crash.stay_s", "0 to 86400; default 0: they leave at once",                           \
      "how long they stand in the way")                                                            \
    X("background", "",                                                                            \
      "runs without driver errors, which tell what crashes are the network's own")                 \
    X("background.duration_s", "0: none; default: duration_s", "simulated time of each")           \
    X("background.seeds", "default: 3, or as many as replications", "how many for each network")   \
    X("assessment", "texts; all optional",                                                         \
      "what only a person can say of the study; on the report")                                    \
    X("scenarios", "", "traffic: networks, demand, and how drivers err")                           \
    X("scenarios[].name", "like study", "")                                                        \
    X("scenarios[].sumocfg", "a file, as seen from the study file", "configuration of SUMO")       \
    X("scenarios[].sumo_options", "words of SUMO's command line", "before those of the .sumocfg")  \
    X("scenarios[].driver_errors", "default: none", "how drivers err; several act at once")        \
    X("scenarios[].driver_errors[].model", "a driver error (below)", "")                           \
    X("scenarios[].driver_errors[].parameters", "default: all defaults", "its parameters (below)") \
    X("variants", "", "what is compared")                                                          \
    X("variants[].name", "like study", "")                                                         \
    X("variants[].functions", "default: none", "driver assistance functions; several act at once") \
    X("variants[].functions[].function", "a function (below); plugin: one of your own", "")        \
    X("variants[].functions[].parameters", "default: all defaults", "its parameters (below)")      \
    X("variants[].functions[].equipment", "", "share of equipped cars by SUMO vehicle type")       \
    X("variants[].functions[].equipment[].type", "a vehicle type of SUMO", "")                     \
    X("variants[].functions[].equipment[].penetration_1", "0 to 1",                                \
      "share of its cars that have the function")                                                  \
    X("variants[].functions[].library", "a file, as seen from the study file",                     \
      "of plugin: the library")                                                                    \
    X("variants[].functions[].as", "default: name of the library",                                 \
      "of plugin: its name in tables")                                                             \
    X("variants[].functions[].data", "a file", "of plugin: what it may read")                      \
    X("vehicles", "", "what SUMO's cars crash as")                                                 \
    X("vehicles.default", "a shipped vehicle, or a file", "of every car not named below")          \
    X("vehicles.types", "", "by vehicle type of SUMO")                                             \
    X("vehicles.types[].type", "a vehicle type of a scenario", "")                                 \
    X("vehicles.types[].model", "a shipped vehicle, or a file", "")                                \
    X("vehicles.fleet", "default", "draw every car from a vehicle class (db/vehicles/fleet)")      \
    X("vehicles.market", "", "shares of classes within a SUMO vehicle type; their sum is 1")       \
    X("vehicles.market[].type", "a vehicle type of a scenario", "")                                \
    X("vehicles.market[].class", "a vehicle class", "")                                            \
    X("vehicles.market[].share_1", "0 to 1", "")                                                   \
    X("counterfactual", "", "of design counterfactual")                                            \
    X("counterfactual.checkpoint_interval_s", "0.5 to 60; default 2", "time between checkpoints")  \
    X("counterfactual.checkpoints", "1 to 200; default 20", "checkpoints kept at a time")          \
    X("counterfactual.time_series_s", "0 to 60; default 0",                                        \
      "TTC, requests and speeds kept around each contact")                                         \
    X("counterfactual.horizon_s", "1 to 120; default 10",                                          \
      "how long after the baseline's contact a branch goes on")                                    \
    X("sweep", "",                                                                                 \
      "parameters that take several values: every combination is a scenario or variant")           \
    X("sweep[].parameter",                                                                         \
      "variants.NAME.FUNCTION.PARAMETER, scenarios.NAME.MODEL.PARAMETER, ...sumo_options.OPTION",  \
      "what is swept")                                                                             \
    X("sweep[].values", "numbers", "its values; or:")                                              \
    X("sweep[].from", "a number", "the first")                                                     \
    X("sweep[].to", "a number", "the last")                                                        \
    X("sweep[].steps", "2 or more", "how many, evenly spaced")

#define CP_VEHICLE_KEYS(X)                                                                         \
    X("vehicle", "", "name in results")                                                            \
    X("description", "", "what it is and where its numbers come from")                             \
    X("calibrated", "default: never calibrated, every result is marked", "range it was fitted in") \
    X("calibrated.speed_min_km_h", "", "")                                                         \
    X("calibrated.speed_max_km_h", "", "")                                                         \
    X("calibrated.offset_max_mm", "", "to either side")                                            \
    X("calibrated.angle_max_deg", "", "either way")                                                \
    X("barrier", "", "barrier of the study it was fitted to")                                      \
    X("barrier.width_m", "", "")                                                                   \
    X("barrier.depth_m", "", "")                                                                   \
    X("barrier.corner_radius_m", "", "")                                                           \
    X("barrier.pivot_m", "", "the angle turns it about a point this far before its face")          \
    X("barrier.source", "", "where that comes from")                                               \
    X("parameters", "", "those of the car; what is not named keeps its default (below)")           \
    X("parameters[].name", "a parameter (below)", "")                                              \
    X("parameters[].value", "within its range", "")                                                \
    X("parameters[].unit", "that of the parameter", "checked")                                     \
    X("parameters[].source", "", "where the value comes from")                                     \
    X("parameters[].min", "default: of the parameter", "bound of the value")                       \
    X("parameters[].max", "default: of the parameter", "bound of the value")                       \
    X("parameters[].scatter", "default 0", "relative standard deviation")                          \
    X("ensemble", "at most 10 values each", "parameter sets that fit about as well")               \
    X("ensemble[].name", "a parameter", "")                                                        \
    X("ensemble[].values", "", "its value in every set")

#define CP_FIT_KEYS(X)                                                                             \
    X("fit", "", "name of the fitted vehicle")                                                     \
    X("description", "", "of the fitted vehicle")                                                  \
    X("base", "a vehicle file", "where the fit starts, and all that is not fitted")                \
    X("objective", "olc (default), pulse", "what is made small")                                   \
    X("reference", "a CSV file", "of objective olc: the table of OLC values")                      \
    X("pulses", "", "of objective pulse: the pulses")                                              \
    X("pulses[].speed_km_h", "default: the one recorded", "")                                      \
    X("pulses[].offset_mm", "default 0", "of the barrier")                                         \
    X("pulses[].angle_deg", "default 0", "of the barrier")                                         \
    X("pulses[].file", "a CSV file of 'crash --pulse'", "")                                        \
    X("pulses[].ev5", "a folder of NHTSA's EV5 form", "")                                          \
    X("pulses[].channels", "numbers", "of ev5: longitudinal accelerometers, averaged")             \
    X("pulses[].until_s", "default: the whole record", "compared to here")                         \
    X("pulses[].weight", "default 1", "in the mean over pulses")                                   \
    X("calibrated", "default: that of the references", "range to state in the vehicle file")       \
    X("calibrated.speed_min_km_h", "", "")                                                         \
    X("calibrated.speed_max_km_h", "", "")                                                         \
    X("calibrated.offset_max_mm", "", "")                                                          \
    X("calibrated.angle_max_deg", "", "")                                                          \
    X("calibrated.reason", "", "why that range")                                                   \
    X("output", "a .yaml file in this folder or below", "the fitted vehicle")                      \
    X("algorithm", "de (default), sade, cmaes", "of the global search")                            \
    X("seed", "", "of all random draws")                                                           \
    X("population", "default 40", "of the global search")                                          \
    X("generations", "default 150", "of the global search; those of cmaes count ten each")         \
    X("global_time_step_s", "default 0.0005", "of crashes in the global search")                   \
    X("local_time_step_s", "default 0.0005", "of crashes in the local search")                     \
    X("local_evaluations", "default 1000", "of Nelder-Mead")                                       \
    X("starts", "default 1",                                                                       \
      "global searches from other seeds; with generations 0 drawn vehicles")                       \
    X("offspring", "default 0", "children of drawn starts")                                        \
    X("slope_evaluations", "default 0", "of least squares")                                        \
    X("soft_g", "default 0.3", "error from which on least squares count its absolute value")       \
    X("prior_g", "default 0",                                                                      \
      "what moving an unknown through its bounds must take off the errors")                        \
    X("folds", "default 0", "of a cross-validation")                                               \
    X("neighbour_folds", "default 0", "likewise, each fold one of every so many neighbours")       \
    X("leave_out", "speed, offset, angle", "likewise, without one level at a time")                \
    X("plausible", "", "of objective olc: bounds of the pulse of one run against the barrier")     \
    X("plausible.speed_km_h", "", "of that run")                                                   \
    X("plausible.offset_mm", "default 0", "")                                                      \
    X("plausible.angle_deg", "default 0", "")                                                      \
    X("plausible.t_v0_ms", "", "time at which the car stands")                                     \
    X("plausible.t_v0_ms.min", "", "")                                                             \
    X("plausible.t_v0_ms.max", "", "")                                                             \
    X("plausible.crush_mm", "", "dynamic crush")                                                   \
    X("plausible.crush_mm.min", "", "")                                                            \
    X("plausible.crush_mm.max", "", "")                                                            \
    X("plausible.peak_g", "", "largest deceleration, CFC60")                                       \
    X("plausible.peak_g.min", "", "")                                                              \
    X("plausible.peak_g.max", "", "")                                                              \
    X("plausible.rebound_m_s", "", "speed after the crash, backwards")                             \
    X("plausible.rebound_m_s.min", "", "")                                                         \
    X("plausible.rebound_m_s.max", "", "")                                                         \
    X("plausible.source", "", "where the bounds come from")                                        \
    X("targets", "", "further crashes and what must lie within corridors of theirs")               \
    X("targets[].name", "", "")                                                                    \
    X("targets[].source", "", "where the corridors come from")                                     \
    X("targets[].against", "barrier (default), itself", "the opponent")                            \
    X("targets[].speed_km_h", "", "of the car; against itself: of both")                           \
    X("targets[].offset_mm", "default 0", "")                                                      \
    X("targets[].angle_deg", "default 0", "")                                                      \
    X("targets[].barrier", "default: that of the vehicle file", "")                                \
    X("targets[].barrier.width_m", "", "")                                                         \
    X("targets[].barrier.depth_m", "", "")                                                         \
    X("targets[].barrier.corner_radius_m", "", "")                                                 \
    X("targets[].weight", "default 1", "")                                                         \
    X("targets[].bounds", "", "the corridors")                                                     \
    X("targets[].bounds[].quantity",                                                               \
      "olc_g, peak_g, crush_mm, t_v0_ms, rebound_m_s, restitution_1, loss_x_m_s, gain_away_m_s, "  \
      "yaw_rate_deg_s",                                                                            \
      "")                                                                                          \
    X("targets[].bounds[].at_ms", "", "instant of the last three")                                 \
    X("targets[].bounds[].min", "", "")                                                            \
    X("targets[].bounds[].max", "", "")                                                            \
    X("targets[].bounds[].aim", "default: the middle", "")                                         \
    X("ensemble", "0 to 10; default 0", "parameter sets to keep that fit about as well")           \
    X("ensemble_within_1", "default 0.15",                                                         \
      "about as well: cost at most this share above the best's")                                   \
    X("threads", "default 1", "the result does not depend on it")                                  \
    X("unknowns", "", "what is fitted")                                                            \
    X("unknowns[].name", "a parameter of vehicles; barrier.width_m, ...", "")                      \
    X("unknowns[].min", "", "")                                                                    \
    X("unknowns[].max", "", "")

#define CP_SUITE_KEYS(X)                                                                           \
    X("suite", "", "name")                                                                         \
    X("description", "", "")                                                                       \
    X("quantiles", "a CSV file", "of test populations")                                            \
    X("vehicles", "shipped vehicles, or files", "that are judged")                                 \
    X("classes", "", "classes of tests")                                                           \
    X("classes[].class", "", "name")                                                               \
    X("classes[].title", "", "for readers")                                                        \
    X("classes[].note", "", "for readers")                                                         \
    X("classes[].vehicles", "default: all", "the only ones it judges")                             \
    X("classes[].table", "", "cases from a file, in place of the lists")                           \
    X("classes[].table.form", "olc, separation, oblique, reconstructed", "")                       \
    X("classes[].table.file", "a CSV file", "")                                                    \
    X("classes[].table.references_file", "a CSV file", "in the folder of --references")            \
    X("classes[].table.rows_with", "", "of separation: names of barriers")                         \
    X("classes[].speeds_km_h", "", "every speed with every overlap, side and angle is a case")     \
    X("classes[].opponent_speeds_km_h", "one for each speed", "")                                  \
    X("classes[].overlaps_1", "shares of the car's width", "")                                     \
    X("classes[].overlap_sweep", "", "in place of overlaps_1")                                     \
    X("classes[].overlap_sweep.from_1", "", "")                                                    \
    X("classes[].overlap_sweep.to_1", "", "")                                                      \
    X("classes[].overlap_sweep.count", "", "")                                                     \
    X("classes[].sides", "left, right", "of the car that meets the opponent")                      \
    X("classes[].angles_deg", "", "")                                                              \
    X("classes[].barrier", "", "")                                                                 \
    X("classes[].barrier.width_m", "", "")                                                         \
    X("classes[].barrier.depth_m", "", "")                                                         \
    X("classes[].barrier.corner_radius_m", "", "")                                                 \
    X("classes[].barrier.mass_kg", "default: it does not move", "of a barrier that moves")         \
    X("classes[].barrier.yaw_inertia_kg_m2", "", "of a barrier that moves")                        \
    X("classes[].barrier.face_m", "default: rigid", "depth of a face that gives way")              \
    X("classes[].barrier.face_kn", "", "force at which it does")                                   \
    X("classes[].barrier.face_bumper_m", "", "depth of the bumper on its face")                    \
    X("classes[].barrier.face_bumper_kn", "", "force at which that gives way")                     \
    X("classes[].struck", "side, rear", "where the judged car is struck")                          \
    X("classes[].struck_speeds_km_h", "one for each speed; default 0", "its own forward speed")    \
    X("classes[].at_mm", "", "middle of what strikes, from its centre of gravity")                 \
    X("classes[].at_sweep", "", "in place of at_mm")                                               \
    X("classes[].at_sweep.from_mm", "", "")                                                        \
    X("classes[].at_sweep.to_mm", "", "")                                                          \
    X("classes[].at_sweep.count", "", "")                                                          \
    X("classes[].struck_forces_1", "default 1", "times the forces of its side and rear")           \
    X("classes[].against", "same, a shipped vehicle, a file", "in place of a barrier")             \
    X("classes[].compare", "", "what is compared")                                                 \
    X("classes[].compare[].quantity", "a quantity (db/validation/README.md)", "")                  \
    X("classes[].compare[].times_ms", "", "of velocities: the instants")                           \
    X("classes[].compare[].population", "a row of quantiles", "")                                  \
    X("classes[].compare[].reference", "one value, or one a case", "")                             \
    X("classes[].compare[].low", "", "of the corridor")                                            \
    X("classes[].compare[].high", "", "of the corridor")                                           \
    X("classes[].compare[].relative", "yes, no (default)", "errors in per cent")                   \
    X("classes[].compare[].car", "1, 2", "of a table of pairs: this one only")                     \
    X("classes[].compare[].bar", "", "what must hold")                                             \
    X("classes[].compare[].bar.inside_1", "", "least share inside the corridor")                   \
    X("classes[].compare[].bar.mean_abs", "", "largest mean absolute error")                       \
    X("classes[].compare[].bar.median_abs", "", "largest median absolute error")                   \
    X("classes[].compare[].bar.p90_abs", "", "largest 90th percentile of it")                      \
    X("classes[].compare[].bar.max_abs", "", "largest error")                                      \
    X("classes[].compare[].bar.max_step", "", "largest change from a case to the next")            \
    X("classes[].compare[].bar.falling", "yes, no", "the value falls from case to case")           \
    X("classes[].compare[].bar.last_is_highest", "yes, no", "none is above the last case")

#endif
