/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_ASSESSMENT_ITEMS_H
#define STORE_ASSESSMENT_ITEMS_H

/* What of a prospective assessment of safety technology only a person can say, in the order of the
 * steps that published methods agree on (ISO/TR 21934-1:2021 and the P.E.A.R.S. initiative): what
 * is asked, of whom and where, against what, by which models, how it is carried over, what could
 * get worse, how sure it is. Keys of the section `assessment` of a study file; the text stands in
 * study.yaml of the database.
 *
 * X(name, key, title, what it should say). The question itself is `question` of the study file. */
#define CP_ASSESSMENT_ITEMS(X)                                                                     \
    X(CP_ASSESSED_POPULATION, "target_population", "Target population",                            \
      "the road users, vehicles and crashes that the result is meant for")                         \
    X(CP_ASSESSED_MARKET, "target_market", "Target region and time",                               \
      "the region and the years, and how many vehicles have the technology then")                  \
    X(CP_ASSESSED_BASELINE, "baseline", "Baseline",                                                \
      "what the baseline stands for: today's traffic, which functions its vehicles have already")  \
    X(CP_ASSESSED_TECHNOLOGY, "technology", "Treatment",                                           \
      "the technology that the treatments stand for, how mature it is, where it is meant to act")  \
    X(CP_ASSESSED_INPUT, "input_data", "Input data",                                               \
      "where networks, demand, speeds and the mix of vehicles come from")                          \
    X(CP_ASSESSED_DRIVERS, "driver_behaviour", "Driver behaviour",                                 \
      "what the driver errors and their frequency rest on, how drivers react to the technology")   \
    X(CP_ASSESSED_VALIDATION, "validation", "Models and their validation",                         \
      "what of this study's traffic and vehicles was held against observations")                   \
    X(CP_ASSESSED_METRICS, "metrics", "Metrics", "why these measures answer the question")         \
    X(CP_ASSESSED_PROJECTION, "projection", "Projection",                                          \
      "how the result is carried over to the target population")                                   \
    X(CP_ASSESSED_NEGATIVE, "negative_effects", "Negative effects",                                \
      "what could get worse: nuisance, adaptation, other road users")                              \
    X(CP_ASSESSED_UNCERTAINTIES, "uncertainties", "Uncertainties",                                 \
      "what is uncertain beyond the intervals")                                                    \
    X(CP_ASSESSED_SENSITIVITY, "sensitivity", "Sensitivity",                                       \
      "which assumptions were varied and what came of it")                                         \
    X(CP_ASSESSED_LIMITATIONS, "limitations", "Limitations", "what must not be concluded")

typedef enum cp_assessment_item {
#define CP_ASSESSMENT_ITEM_NAME(name, key, title, says) name,
    CP_ASSESSMENT_ITEMS(CP_ASSESSMENT_ITEM_NAME)
#undef CP_ASSESSMENT_ITEM_NAME
        CP_ASSESSMENT_ITEM_COUNT
} cp_assessment_item;

#endif
