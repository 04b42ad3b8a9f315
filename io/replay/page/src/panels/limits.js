// SPDX-License-Identifier: Apache-2.0
// Which limits are marked beside a curve.

/** Share of the range between two limits. */
const NEAR_SHARE = 0.02;

/** The least and the greatest finite value; null where there is none. */
export function extremes(values) {
  let least = Infinity;
  let greatest = -Infinity;
  for (const x of values) {
    if (!Number.isFinite(x)) continue;
    if (x < least) least = x;
    if (x > greatest) greatest = x;
  }
  return least <= greatest ? [least, greatest] : null;
}

/**
 * The limits that are near what a curve comes to: within its span, or within 2 % of the range
 * between them, as NearLimits of recording.hpp has it. The others would flatten the curve.
 */
export function nearLimits({ lower, upper, values }) {
  const ends = extremes(values);
  if (!ends) return {};
  const [least, greatest] = ends;
  const range = lower !== undefined && upper !== undefined ? NEAR_SHARE * (upper - lower) : 0;
  const near = Math.max(greatest - least, range);
  return {
    lower: lower !== undefined && least - lower <= near ? lower : undefined,
    upper: upper !== undefined && upper - greatest <= near ? upper : undefined,
  };
}
