// Numbers as readable text, and colours in the notation of forms.

import type { Vec3 } from '../viewer/types.js';

export const degreesPerRadian = 180 / Math.PI;

const counts = new Intl.NumberFormat('en');

/** "15,000" */
export const countText = (count: number) => counts.format(count);

/** "15,000 triangles", "1 triangle" */
export const trianglesText = (count: number) => `${countText(count)} ${count === 1 ? 'triangle' : 'triangles'}`;

/** "15,000 triangles", "90,854 splats", "7,000 triangles and 90,854 splats" */
export function primitivesText({ triangles, splats }: { readonly triangles: number; readonly splats: number }): string {
  const splatsText = `${countText(splats)} ${splats === 1 ? 'splat' : 'splats'}`;
  if (splats === 0) return trianglesText(triangles);
  return triangles === 0 ? splatsText : `${trianglesText(triangles)} and ${splatsText}`;
}

/** "640 bytes", "9.4 MB": powers of 1000, as usual for networks and disks. */
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes}\u00a0bytes`;
  const units = ['kB', 'MB', 'GB'];
  let value = bytes / 1000, unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1000;
    ++unit;
  }
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)}\u00a0${units[unit]}`;
}

/** "4.27 ms", "157 ms" */
export const millisecondsText = (ms: number) => `${ms.toFixed(ms < 9.95 ? 2 : ms < 99.5 ? 1 : 0)} ms`;

/** Without trailing zeros and without exponent: "0.25", "12". */
export function plainNumber(value: number, decimals: number): string {
  const text = value.toFixed(Math.min(Math.max(decimals, 0), 20));
  const short = text.includes('.') ? text.replace(/\.?0+$/, '') : text;
  return short === '-0' ? '0' : short;
}

export const isVector = (value: unknown): value is Vec3 =>
  Array.isArray(value) && value.length === 3 && value.every((part) => Number.isFinite(part));

/** Three numbers with this separator, as in a link; null for another text. */
export function readVector(text: string, separator: string): Vec3 | null {
  const values = text.split(separator).map((part) => (part.trim() === '' ? NaN : Number(part)));
  return isVector(values) ? values : null;
}

/** "#20242e" for colours with channels in 0..1. */
export function hexColor(color: Vec3): string {
  const digits = (part: number) =>
    Math.round(Math.min(Math.max(part, 0), 1) * 255).toString(16).padStart(2, '0');
  return '#' + color.map(digits).join('');
}

/** Null if the text does not have the form "#20242e". */
export function colorFromHex(text: string): Vec3 | null {
  const parts = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(text);
  if (!parts) return null;
  return [parseInt(parts[1]!, 16) / 255, parseInt(parts[2]!, 16) / 255, parseInt(parts[3]!, 16) / 255];
}
