/** What cameras see, and numbers with their uncertainty, as the bench gives them. */

import type { Component } from "../twin/scene";

export type Mark =
  | { mark: "cross"; of: string; x: number; y: number }
  | { mark: "box"; of: string; x: number; y: number; width: number; height: number }
  | { mark: "ellipse"; of: string; x: number; y: number; major: number; minor: number; angle: number };
export type Numbers = number | Record<string, number> | null;
export interface Kernelled { value: Numbers; sigma: Numbers; unit: string; unknown: string; kernel: string }
export interface Still {
  schema: "pico.still/v1"; component: string; measurable: string; png: string; width: number; height: number; by: number;
  settings: Record<string, unknown>; saturated: string; values: Record<string, Kernelled>; marks: Mark[]; age: number; waits: string;
}

interface Measurable { datatype: string; unit: string; kernel?: string | null; description?: string }

/** What of a component can be measured, as its type has it. */
export function measurables(part: Component | undefined): Record<string, Measurable> {
  return (part?.measurables ?? {}) as Record<string, Measurable>;
}

/** The components that see pictures. */
export function cameras(parts: Component[]): Component[] {
  return parts.filter((one) => measurables(one).image?.datatype === "image");
}

/** Numbers with their uncertainty and unit: `x -624.31 ± 0.02 um`. */
export function lines(one: Kernelled): { name: string; value: number; sigma: number | null; unit: string }[] {
  if (one.value === null) return [];
  if (typeof one.value === "number") return [{ name: "", value: one.value, sigma: typeof one.sigma === "number" ? one.sigma : null, unit: one.unit }];
  const sigma = typeof one.sigma === "object" ? one.sigma : null;
  const units = one.unit.split(", ");
  return Object.entries(one.value).map(([name, value], i) => ({ name, value, sigma: sigma?.[name] ?? null, unit: units[i] ?? one.unit }));
}

/** A number as far as it is known: `-624.31 ± 0.02`. */
export function withSigma(value: number, sigma: number | null): string {
  if (!sigma || !Number.isFinite(sigma)) return String(Number(value.toPrecision(5)));
  const digits = Math.max(0, Math.min(8, 1 - Math.floor(Math.log10(sigma))));
  return `${value.toFixed(digits)} ± ${sigma.toFixed(digits)}`;
}
