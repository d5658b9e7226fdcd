// The page's download: JSON for `tureen report` (docs/json.md).

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
