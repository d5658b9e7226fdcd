// The page's downloads: JSON for `tureen report` (docs/json.md), and CSV for spreadsheets.

import { clockSentence } from './clock.js';
import { minSampleMs, type Measurement, type MeasuredScene } from './measure.js';
import type { Device } from './bench_engine.js';

/** Set by build.mjs. */
declare const builtVersion: string, builtCommit: string;

const measurementInFile = ({ cameraSet, width, height, result }: Measurement) => ({
  camera_set: cameraSet, width, height,
  frames_per_sample: result.frames_per_sample,
  self_test_ms: result.self_test_ms,
  entrants: result.entrants.map(({ name, stable, frame_ms, pixels_hash }) =>
    ({ configuration: name, stable, frame_ms, pixels_hash })),
});

const sceneInFile = (scene: MeasuredScene) => ({
  name: scene.name, source: scene.source, triangles: scene.triangles, appearance: scene.appearance,
  read_ms: scene.readMs, wasm_bytes: scene.wasmBytes,
  configurations: scene.configurations.map(({ name, plan, specialisations, plan_ms, upload_ms, device_bytes }) =>
    ({ name, plan, specialisations, plan_ms, upload_ms, device_bytes })),
  measurements: scene.measurements.map(measurementInFile),
  notes: scene.notes,
});

export type BenchFile = ReturnType<typeof benchFile>;

/** docs/json.md describes the members. */
export function benchFile(device: Device, scenes: readonly MeasuredScene[]) {
  return {
    format: 'tureen web bench', version: 1,
    date: new Date().toISOString().replace(/\.\d+Z$/, 'Z'),
    page: { version: builtVersion, commit: builtCommit, address: location.href },
    device: {
      user_agent: navigator.userAgent, renderer: device.renderer, vendor: device.vendor, gl_version: device.gl_version,
      software: device.limits.software, cores: navigator.hardwareConcurrency ?? 0, pixel_ratio: devicePixelRatio,
      screen_width: screen.width, screen_height: screen.height,
    },
    protocol: { clock: clockSentence(minSampleMs()) },
    scenes: scenes.map(sceneInFile),
  };
}

const quoted = (text: string) => (/[,"\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** One line per configuration and size, with the column names of `tureen bench`. */
export function benchCsv(file: BenchFile, scenes: readonly MeasuredScene[]): string {
  const rows = scenes.flatMap((scene) => scene.measurements.flatMap(({ cameraSet, width, height, result }) =>
    result.entrants.map(({ name, stable, frame_ms, pixels_hash, statistics: ms }) => ({
      configuration: name, camera_set: cameraSet, width, height,
      views: frame_ms[0]!.length, rounds: frame_ms.length,
      mean_ms: ms.mean, median_ms: ms.median, p95_ms: ms.p95, p99_ms: ms.p99, min_of_medians_ms: ms.min_of_medians,
      spread: ms.spread, aa_spread: result.aa_spread, low_1_percent_fps: ms.low_1_percent_fps, stable, pixels_hash,
      device_bytes: scene.configurations.find((one) => one.name === name)!.device_bytes, wasm_bytes: scene.wasmBytes,
      scene: scene.name, triangles: scene.triangles, renderer: file.device.renderer,
      commit: file.page.commit, date: file.date,
    }))));
  const line = (values: readonly unknown[]) => values.map((value) => quoted(String(value))).join(',') + '\n';
  return line(Object.keys(rows[0] ?? {})) + rows.map((row) => line(Object.values(row))).join('');
}
