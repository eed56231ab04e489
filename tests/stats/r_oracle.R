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
# Severity of two samples in clusters and strata: Cliff's delta over the strata weighted with
# n_a n_b / (n_a + n_b), its jackknife over whole clusters (pairs of them when paired), Kish's and
# Satterthwaite's degrees of freedom, t test and interval.
set.seed(20261129)
clusters <- 12; strata <- rep(0:1, each = 6)
ca <- sort(rep(0:(clusters - 1), times = c(3, 1, 0, 4, 2, 5, 2, 2, 6, 1, 3, 4)))
cb <- sort(rep(0:(clusters - 1), times = c(1, 2, 1, 0, 3, 2, 0, 1, 2, 2, 4, 1)))
va <- round(14 + 5 * strata[ca + 1] + rnorm(12)[ca + 1] + 3 * rnorm(length(ca)))
vb <- round(12 + 5 * strata[cb + 1] + rnorm(12)[cb + 1] + 3 * rnorm(length(cb)))
name("RANK_A", va); name("RANK_A_CLUSTER", ca); name("RANK_B", vb); name("RANK_B_CLUSTER", cb)
name("RANK_STRATUM", strata)
stratified_delta <- function(ka, kb, s) {
  d <- 0; w <- 0
  for (h in unique(s)) {
    a <- va[ka & s[ca + 1] == h]; b <- vb[kb & s[cb + 1] == h]
    if (length(a) == 0 || length(b) == 0) next
    own <- length(a) * length(b) / (length(a) + length(b))
    d <- d + own * mean(sign(outer(b, a, "-"))); w <- w + own
  }
  d / w
}
jack <- function(out_a, out_b, s) {
  left <- sapply(0:(clusters - 1), function(k)
    stratified_delta(!(out_a & ca == k), !(out_b & cb == k), s))
  sum(tapply(left, s, function(l) (length(l) - 1) / length(l) * sum((l - mean(l))^2)))
}
kish <- function(cluster, s) {
  m <- tabulate(cluster + 1, clusters)
  sum(tapply(m, s, function(x) sum(x)^2 / sum(x^2) - 1))
}
rank_test <- function(s, paired) {
  delta <- stratified_delta(rep(TRUE, length(va)), rep(TRUE, length(vb)), s)
  v <- c(jack(TRUE, FALSE, s), jack(FALSE, TRUE, s)); f <- c(kish(ca, s), kish(cb, s))
  df <- sum(v)^2 / sum(v^2 / f)
  if (paired) df <- min(df, f)
  se <- sqrt(if (paired) jack(TRUE, TRUE, s) else sum(v))
  c(delta, se, df, 2 * pt(-abs(delta) / se, df), delta + c(-1, 1) * qt(0.975, df) * se)
}
name("RANK_APART", rank_test(rep(0, clusters), FALSE))
name("RANK_PAIRED", rank_test(rep(0, clusters), TRUE))
name("RANK_STRATA_APART", rank_test(strata, FALSE))
name("RANK_STRATA_PAIRED", rank_test(strata, TRUE))
# Both samples at the same mix of strata: quantiles of weighted values that add up to their number.
mixed <- function(v, cluster, other) {
  n <- table(factor(strata[cluster + 1], 0:1)); o <- table(factor(strata[other + 1], 0:1))
  w <- (n * o / (n + o) / n)[strata[cluster + 1] + 1]
  w <- as.numeric(w) * length(v) / sum(w)
  order_statistic <- function(rank) {
    i <- order(v)
    approx(cumsum(tapply(w[i], v[i], sum)), sort(unique(v)), rank - 0.5 + 1e-9,
           method = "constant", f = 1, rule = 2)$y
  }
  quantile_at <- function(p) {
    place <- 1 + (length(v) - 1) * p; low <- max(floor(place), 1); high <- min(low + 1, length(v))
    share <- place - low
    (1 - share) * order_statistic(low) + share * order_statistic(high)
  }
  c(sum(w * v) / sum(w), quantile_at(0.5), quantile_at(0.9))
}
name("MIXED_DIFFERENCE", mixed(vb, cb, ca) - mixed(va, ca, cb))

# Counts in strata: Mantel and Haenszel's ratio of two rates, the dispersion of its logarithm, and the
# mid-P interval of counts divided by the factor (t / z)^2 dispersion.
ya <- c(15, 2, 7, 18, 3, 8, 1, 0, 5, 1, 6, 0); yb <- c(4, 3, 9, 7, 1, 3, 1, 4, 0, 0, 2, 1)
xa <- c(100, 90, 95, 110, 105, 98, 200, 210, 190, 205, 195, 200)
xb <- c(98, 92, 97, 108, 101, 99, 150, 160, 170, 155, 150, 165)
name("MH_YA", ya); name("MH_YB", yb); name("MH_XA", xa); name("MH_XB", xb)
Xa <- tapply(xa, strata, sum)[strata + 1]; Xb <- tapply(xb, strata, sum)[strata + 1]
qa <- Xb / (Xa + Xb); qb <- Xa / (Xa + Xb)
A <- sum(qa * ya); B <- sum(qb * yb)
apart <- function(y, x) y - (tapply(y, strata, sum) / tapply(x, strata, sum))[strata + 1] * x
ua <- qa * apart(ya, xa) / A; ub <- qb * apart(yb, xb) / B
within <- function(u) sum(u^2) * 6 / 5
poisson <- sum(qa^2 * ya) / A^2 + sum(qb^2 * yb) / B^2
mid_share <- function(b, a) {
  cdf <- function(s) (pbeta(s, b, a + 1) + pbeta(s, b + 1, a)) / 2
  sapply(c(0.025, 0.975), function(p) uniroot(function(s) cdf(s) - p, c(1e-12, 1 - 1e-12), tol = 1e-15)$root)
}
ratio_interval <- function(variance, df) {
  dispersion <- variance / poisson
  factor <- max(1, dispersion * (qt(0.975, df) / qnorm(0.975))^2)
  ea <- A^2 / sum(qa^2 * ya); eb <- B^2 / sum(qb^2 * yb)
  s <- mid_share(eb / factor, ea / factor)
  c(B / A, dispersion, factor, B / A * ea / eb * s / (1 - s))
}
v <- c(within(ua), within(ub))
name("MH_APART", ratio_interval(sum(v), sum(v)^2 / sum(v^2 / 10)))
name("MH_PAIRED", ratio_interval(within(ub - ua), 10))
mid_mean <- function(n) {
  cdf <- function(m) (pgamma(m, n) + pgamma(m, n + 1)) / 2
  sapply(c(0.025, 0.975), function(p) uniroot(function(m) cdf(m) - p, c(1e-9, 10 * n + 20), tol = 1e-14)$root)
}
dispersion <- within(apart(ya, xa)) / sum(ya)
factor <- max(1, dispersion * (qt(0.975, 10) / qnorm(0.975))^2)
name("WIDENED_RATE", c(dispersion, factor, mid_mean(sum(ya) / factor) * factor / sum(xa)))
cat("\n/* clang-format on */\n#endif\n")
