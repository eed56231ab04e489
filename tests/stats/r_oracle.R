# SPDX-License-Identifier: GPL-3.0-or-later
# Values of R for tests/stats/test_r_oracle.c: Rscript tests/stats/r_oracle.R > tests/stats/r_oracle.h
# Packages: stats (part of R), boot. The tests read the header; they need no R.
suppressMessages(library(boot))
name <- function(text, values) {
  cat(sprintf("static const double R_%s[] = {%s};\n", text,
              paste(sprintf("%.17g", values), collapse = ",\n    ")))
}
cat("/* SPDX-License-Identifier: GPL-3.0-or-later */\n")
cat("/* Written by r_oracle.R; not edited by hand. */\n")
cat(sprintf("/* %s, boot %s */\n", R.version.string, packageVersion("boot")))
cat("#ifndef TESTS_STATS_R_ORACLE_H\n#define TESTS_STATS_R_ORACLE_H\n\n/* clang-format off */\n")

# Two samples without ties, and one with them.
set.seed(20090601)
x <- round(exp(3.0 + 0.35 * rnorm(31)), 6)
y <- round(exp(2.8 + 0.40 * rnorm(24)), 6)
name("X", x)
name("Y", y)
probabilities <- c(0, 0.25, 0.5, 0.75, 0.9, 0.95, 1)
name("X_QUANTILES", quantile(x, probabilities, type = 7))
name("Y_QUANTILES", quantile(y, probabilities, type = 7))
name("X_MEAN_SD", c(mean(x), sd(x)))
name("X_ECDF_AT_20", ecdf(x)(20))
w <- wilcox.test(y, x, exact = TRUE)
name("MANN_WHITNEY_U_P", c(w$statistic, w$p.value))
k <- ks.test(x, y, exact = TRUE)
name("KS_D_P", c(k$statistic, k$p.value))
name("CLIFFS_DELTA", mean(sign(outer(y, x, "-"))))
xt <- round(x / 4); yt <- round(y / 4)
name("TIED_U", suppressWarnings(wilcox.test(yt, xt)$statistic))
name("TIED_DELTA", mean(sign(outer(yt, xt, "-"))))
name("TIED_KS_D", suppressWarnings(ks.test(xt, yt)$statistic))

# Paired differences: Walsh averages, signed ranks.
d <- round(y - x[1:24], 6)
s <- wilcox.test(d, exact = TRUE, conf.int = TRUE)
name("D", d)
name("SIGNED_RANK_V_P", c(s$statistic, s$p.value))
walsh <- function(v) { m <- outer(v, v, "+") / 2; m[upper.tri(m, diag = TRUE)] }
name("HODGES_LEHMANN", c(median(walsh(d)), s$estimate))
name("HODGES_LEHMANN_ODD", median(walsh(d[1:21])))
name("HODGES_LEHMANN_TIED", median(walsh(round(d))))
z <- round(d); z <- z[z != 0]
name("SIGNED_RANK_TIED_V", suppressWarnings(wilcox.test(z)$statistic))

# Counts and rates.
garwood <- function(n) poisson.test(n)$conf.int
name("GARWOOD", c(garwood(0), garwood(1), garwood(5), garwood(10), garwood(100)))
ratio <- poisson.test(c(31, 52), c(8123.5, 7904.25))
name("RATE_RATIO", c(ratio$estimate, ratio$conf.int))
counts <- c(3, 0, 7, 2, 5, 1, 4, 9); km <- c(101.5, 98, 120.25, 99, 110, 97.5, 105, 118)
fit <- glm(counts ~ 1 + offset(log(km)), family = poisson)
name("DISPERSION", sum(residuals(fit, "pearson")^2) / fit$df.residual)
name("COUNTS", counts)
name("KM", km)
p <- c(0.031, 0.0004, 0.21, 0.012, 0.012, 0.6)
name("P", p)
name("P_HOLM", p.adjust(p, "holm"))

# Risk functions.
v <- c(2, 8, 15, 25)
mph <- v * 3600 / 1609.344
name("RISK_LOGISTIC_MPH", plogis(-3.761 + 0.136 * mph))
name("RISK_LOG_LOGISTIC", plogis(-8 + 3 * log(v)))
name("RISK_PROBIT", pnorm(-3 + 0.15 * 3.6 * v))
name("RISK_WEIBULL", pweibull(v, shape = 2.5, scale = 18))

# Bootstrap over clusters, BCa: the mean of values in clusters of unequal size, and the variance of
# Efron and Tibshirani's test A (1993, section 14.2).
cluster <- rep(1:25, times = rep(1:5, 5)); set.seed(7)
value <- round(20 + 4 * rnorm(25)[cluster] + 3 * rnorm(length(cluster)), 6)
name("CLUSTER", cluster - 1)
name("VALUE", value)
totals <- cbind(tapply(value, cluster, sum), tapply(value, cluster, length))
set.seed(11)
b <- boot(totals, function(t, i) sum(t[i, 1]) / sum(t[i, 2]), R = 200000)
name("CLUSTER_MEAN_BCA", c(b$t0, boot.ci(b, type = "bca")$bca[4:5]))
a <- c(48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6, 0, 33, 28, 34, 4, 32, 24, 47, 41, 24, 26, 30, 41)
name("TEST_A", a)
set.seed(12)
b <- boot(a, function(t, i) mean((t[i] - mean(t[i]))^2), R = 200000)
name("VARIANCE_BCA_90", c(b$t0, boot.ci(b, conf = 0.9, type = "bca")$bca[4:5]))
name("T_REACH_30", sqrt(30 / 29) * qt(0.975, 29))
cat("\n/* clang-format on */\n#endif\n")
