// The summary of a scene for the page, from the loader's description and the device's facts.

import type { PreparedScene } from './loader_messages.js';
import type { SceneSummary } from './types.js';

/** The result of the command "show": web/engine/viewer.cpp. */
export interface ShownFacts {
  readonly plan: readonly string[];
  /** Number of drawn triangles. */
  readonly drawn: number;
  readonly device_bytes: number;
}

export const lowerLevelSentence = (level: number) =>
  `This device has not enough memory for the whole scene. The scene is drawn with lattice level ${level}.`;

export const nothingDrawn = 'The scene cannot be drawn: it has no triangles with finite corners and an area.';

export function sceneSummary({ description }: PreparedScene, facts: ShownFacts): SceneSummary {
  const { name, source, notes, triangles, appearance, cameras, background, subject, debug_views } = description;
  return {
    name, source, triangles, appearance, background,
    notes: [...notes, ...(facts.drawn ? [] : [nothingDrawn])],
    plan: facts.plan,
    cameras: cameras.map(({ name, width, height }) => ({ name, width, height })),
    up: subject.up,
    upReason: description.up_reason,
    debugViews: debug_views,
    featureCount: description.feature_count,
    deviceBytes: facts.device_bytes,
  };
}
