// SPDX-License-Identifier: GPL-3.0-or-later
// Real crashes under the study's curves of delta-v: vehicles struck on the front, tow-away, without rebound.

// Of the selected crash type, of all three without one; null where the field has none of it.
UNDER_DELTA_V.push(() => {
  const curve = data.field && data.field.curves[state.crashType || "all"];
  return curve ? { label: `${data.field.name} (n = ${integer(curve.n)})`, x: data.field.x, share: curve.share, first: 0 } : null;
});
