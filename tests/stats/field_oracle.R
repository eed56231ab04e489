# SPDX-License-Identifier: GPL-3.0-or-later
# Values of R for tests/stats/test_raked.c: Rscript tests/stats/field_oracle.R > tests/stats/field_oracle.h
# Packages: stats (part of R), survey (its rake, an implementation of its own). The tests read the
# header; they need no R.
suppressMessages(library(survey))
name <- function(text, values) {
  cat(sprintf("static const double R_%s[] = {%s};\n", text,
              paste(sprintf("%.17g", values), collapse = ",\n    ")))
}
cat("/* SPDX-License-Identifier: GPL-3.0-or-later */\n")
cat("/* Written by field_oracle.R; not edited by hand. */\n")
cat(sprintf("/* %s, survey %s */\n", R.version.string, packageVersion("survey")))
cat("#ifndef TESTS_STATS_FIELD_ORACLE_H\n#define TESTS_STATS_FIELD_ORACLE_H\n\n/* clang-format off */\n")

# 60 units of three margins in 12 clusters; severity depends on the second margin.
set.seed(20261130)
n <- 60
d <- data.frame(cluster = sort(sample(0:11, n, TRUE)), type = sample(0:2, n, TRUE, c(.6, .3, .1)),
                bin = sample(0:3, n, TRUE, c(.2, .3, .3, .2)), overlap = sample(0:1, n, TRUE))
d$severity <- round(8 + 4 * d$bin + 3 * rnorm(n), 6)
d$km <- 1
targets <- list(type = c(.25, .5, .25), bin = c(.4, .3, .2, .1), overlap = c(.35, .65))
rake_weights <- function(d) {
  s <- svydesign(ids = ~1, weights = ~km, data = d)
  margin <- function(v) {
    there <- sort(unique(d[[v]])); share <- targets[[v]][there + 1]
    setNames(data.frame(there, share / sum(share) * nrow(d)), c(v, "Freq"))
  }
  weights(rake(s, list(~type, ~bin, ~overlap), lapply(c("type", "bin", "overlap"), margin),
               control = list(maxit = 5000, epsilon = 1e-11)))
}
w <- rake_weights(d)
# Type 7 where every weight is 1: neighbours lie half of their weights apart.
wquantile <- function(x, w, p) {
  o <- order(x); x <- x[o]; w <- w[o]
  at <- c(0, cumsum((w[-1] + w[-length(w)]) / 2))
  approx(at, x, p * max(at))$y
}
d <- d[order(d$severity), ]; w <- w[as.character(rownames(d))]
if (is.null(names(w)) || anyNA(w)) w <- rake_weights(d)
for (v in c("cluster", "type", "bin", "overlap", "severity")) name(toupper(paste0("UNIT_", v)), d[[v]])
name("WEIGHTS", w)
name("EFFECTIVE", sum(w)^2 / sum(w^2))
name("TARGET_TYPE", targets$type); name("TARGET_BIN", targets$bin); name("TARGET_OVERLAP", targets$overlap)
exposure <- 90 + 5 * (0:11)
name("EXPOSURE", exposure)
above <- as.numeric(d$severity > 15)
name("RATES", c(sum(w), sum(w * above)) / sum(exposure))
name("QUANTILES", c(wquantile(d$severity, w, .5), wquantile(d$severity, w, .9)))
# One resample: each cluster as often as this, weights found anew.
times <- c(2, 0, 1, 1, 3, 0, 1, 1, 2, 0, 1, 0)
k <- rep(seq_len(n), times[d$cluster + 1]); r <- d[k, ]; rw <- rake_weights(r)
name("TIMES", times)
name("RESAMPLE", c(sum(rw * (r$severity > 15)) / sum(times * exposure), wquantile(r$severity, rw, .5)))
# None above 2 times the mean.
s <- uniroot(function(s) mean(pmin(2, s * w)) - 1, c(1, 50), tol = 1e-14)$root
name("CAPPED", pmin(2, s * w))

# Distances of two weighted distributions.
x <- round(rnorm(25, 20, 6), 3); y <- round(rnorm(40, 24, 8), 3)
wx <- round(runif(25, .2, 3), 3); wy <- round(runif(40, .2, 3), 3)
x <- sort(x); y <- sort(y)
grid <- sort(unique(c(x, y)))
fx <- sapply(grid, function(g) sum(wx[x <= g]) / sum(wx)); fy <- sapply(grid, function(g) sum(wy[y <= g]) / sum(wy))
name("DISTANCE_X", x); name("DISTANCE_WX", wx); name("DISTANCE_Y", y); name("DISTANCE_WY", wy)
name("DISTANCES", c(max(abs(fx - fy)), sum(abs(fx - fy)[-length(grid)] * diff(grid))))

# Expected injured by the MAIS3+ function with type, age and sex, and its standard error by the delta
# method with numerical derivatives; delta-v of 20 drivers, two crash types.
b <- c(-6.887664, 0.09801963, -1.463373, -2.027461, 0.9726871, 1.283282, 2.216535, 0.1219741)
triangle <- c(0.2454138, -0.004328784, 8.313941e-05, -0.05729689, 0.0006261524, 0.09436081,
  -0.08069287, 0.0012988, 0.08068416, 0.09590784, -0.05717195, 0.0007949227, -0.01295264,
  -0.01576535, 0.05584339, -0.06259685, 0.000967057, -0.003390754, -0.003205475,
  0.04212886, 0.0468214, -0.01329465, 0.0003382043, -0.02659166, -0.0366783, 0.003093218,
  0.008995125, 0.08679844, -0.07689869, 0.001524486, 0.003072668, 0.01718939, 0.007047889,
  0.01024928, 0.02413036, 0.04108449)
v <- matrix(0, 8, 8); v[upper.tri(v, TRUE)] <- triangle; v <- v + t(v) - diag(diag(v))
age <- c(1 - .3075 - .1228 - .0582, .3075, .1228, .0582); sex <- c(1 - .4544, .4544)
dv <- round(seq(10, 70, length.out = 20), 2); side <- rep(c(0, 1), 10)
sum_of <- function(b) {
  total <- 0
  for (a in 0:3) for (s in 0:1)
    total <- total + age[a + 1] * sex[s + 1] *
      sum(plogis(b[1] + b[2] * dv + b[3] * side + c(0, b[5:7])[a + 1] + b[8] * s))
  total
}
gradient <- sapply(1:8, function(k) {
  h <- 1e-5 * max(1, abs(b[k])); e <- replace(numeric(8), k, h)
  (sum_of(b + e) - sum_of(b - e)) / (2 * h)
})
name("RISK", b); name("RISK_TRIANGLE", triangle); name("RISK_DELTA_V", dv)
name("RISK_SHARES", c(age[-1], sex[2]))
name("RISK_EXPECTED_SE", c(sum_of(b), sqrt(drop(t(gradient) %*% v %*% gradient))))
se <- log_se <- sqrt(drop(t(gradient) %*% v %*% gradient)) / sum_of(b)
z <- qt(.975, 15) * log_se
name("RISK_WIDENED", sum_of(b) * exp(c(-1, 1) * sqrt(log(c(1.3, 1.5))^2 + z^2)))
cat("/* clang-format on */\n\n#endif\n")
