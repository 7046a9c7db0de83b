/** What a plot shows, before anything is drawn. */

/** Numbers over what lies across, null where there is none; `sigmas`: their standard deviations, where these are known. */
export interface Series { name: string; values: (number | null)[]; sigmas?: (number | null | undefined)[]; dots?: boolean }

/** A name with its unit: `p1.angle [deg]`. */
export function labelled({ name, unit }: { name: string; unit?: string }): string {
  return unit && unit !== "1" ? `${name} [${unit}]` : name;
}

/** What an axis shows: all numbers with their bars, and `also`, with some room around. */
export function roomy(series: Series[], also: number[] = []): [number, number] {
  const ends = series.flatMap(({ values, sigmas }) => values.flatMap((value, i) => (value === null ? [] : [value - (sigmas?.[i] ?? 0), value + (sigmas?.[i] ?? 0)])));
  const all = [...ends, ...also].filter(Number.isFinite);
  if (!all.length) return [0, 1];
  const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
  const room = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low - room, high + room];
}

/** What an axis shows by powers of ten: all positive numbers, and `also`; null where they are not worth that, or not all positive. */
export function decades(series: Series[], also: number[] = []): [number, number] | null {
  const values = series.flatMap((one) => one.values).filter((value) => value !== null);
  const all = [...values, ...also.filter((value) => value > 0)];
  if (!values.length || values.some((value) => value <= 0)) return null;
  const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
  return high / low < 30 ? null : [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high))];
}

/** Points in the order of what lies across, as uPlot wants them. */
export function sorted<T extends { x: number }>(points: T[]): T[] {
  return [...points].sort((a, b) => a.x - b.x);
}

/** What a plot shows, in words, for who can't see it. */
export function told(x: number[], series: Series[]): string {
  const last = series.map(({ name, values, sigmas }) => {
    const i = values.findLastIndex((value) => value !== null);
    const sigma = sigmas?.[i];
    return i < 0 ? `${name} none` : `${name} last ${Number(values[i]!.toPrecision(5))}${sigma ? ` ± ${Number(sigma.toPrecision(2))}` : ""}`;
  });
  return [`${x.length} points`, ...last].join("; ");
}
