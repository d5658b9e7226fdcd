// The summary of a scene for the page, from the loader's description and the device's facts.

import type { SceneDescription } from './loader_messages.js';
import type { DebugViewChoice, SceneLayer, SceneSummary } from './types.js';

/** The result of the command "facts": web/engine/viewer.cpp. */
export interface ShownFacts {
  readonly plan: readonly string[];
  /** Number of drawn triangles and splats. */
  readonly drawn: number;
  readonly device_bytes: number;
  readonly by_processor: boolean;
}

export const lowerLevelSentence = (level: number) =>
  `This device has not enough memory for the whole scene. The scene is drawn with lattice level ${level}.`;

export const nothingDrawn = 'The scene cannot be drawn: it has no triangles with finite corners and an area, and no visible splats.';

/** "76 MB" */
const megabytes = (bytes: number) => `${(bytes / 1e6).toFixed(bytes < 9.95e6 ? 1 : 0)}\u00a0MB`;

export const tooLargeSentence = (layer: string, bytes: number) =>
  `This device has not enough memory for the layer “${layer}”, which needs ${megabytes(bytes)}.`;

export const othersDrawn = 'The other layers are drawn.';

/** The debug views that all sources support. */
function debugViewsOf(sources: readonly SceneDescription[]): readonly DebugViewChoice[] {
  return sources[0]!.debug_views.map((choice, index) =>
    sources.map(({ debug_views }) => debug_views[index]!).find(({ missing }) => missing !== null) ?? choice);
}

/** `sources`: descriptions of the sources with layers; `first`: that of the loaded scene. */
export function sceneSummary(first: SceneDescription, sources: readonly SceneDescription[], layers: readonly SceneLayer[],
                             facts: ShownFacts): SceneSummary {
  const { background, cameras, subject, up_reason } = first;
  const distinct = (texts: readonly string[]) => [...new Set(texts.filter(Boolean))];
  return {
    name: sources[0]!.name,
    source: distinct(sources.map(({ source }) => source)).join('; '),
    notes: distinct([...sources.flatMap(({ notes }) => notes), facts.drawn ? '' : nothingDrawn]),
    triangles: layers.reduce((sum, layer) => sum + layer.triangles, 0),
    splats: layers.reduce((sum, layer) => sum + layer.splats, 0),
    appearance: distinct(sources.map(({ appearance }) => appearance)).join(', '),
    background,
    plan: facts.plan,
    cameras: cameras.map(({ name, width, height }) => ({ name, width, height })),
    up: subject.up,
    upReason: up_reason,
    debugViews: debugViewsOf(sources),
    featureCount: Math.min(...sources.map(({ feature_count }) => feature_count)),
    deviceBytes: facts.device_bytes,
    splatsByProcessor: facts.by_processor,
    detail: sources.length === 1 && first.levels.length > 1 ? { splats: first.levels, level: first.lod } : null,
  };
}
