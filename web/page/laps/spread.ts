// Median and quantiles, by the rule of the results table.

export interface Spread {
  p05: number;
  median: number;
  p95: number;
}

/** Linear interpolation (Hyndman & Fan 1996, type 7), as in the core; undefined without values. */
export function spreadOf(values: readonly number[]): Spread | undefined {
  const sorted = [...values].sort((a, b) => a - b);
  const quantile = (share: number): number => {
    const position = share * (sorted.length - 1);
    const low = sorted[Math.floor(position)] ?? 0;
    return low + (position - Math.floor(position)) * ((sorted[Math.ceil(position)] ?? low) - low);
  };
  return sorted.length === 0 ? undefined : { p05: quantile(0.05), median: quantile(0.5), p95: quantile(0.95) };
}
