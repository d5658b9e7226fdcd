// Results on the page: a table and notes. The saved file has more, for `tureen report`.

import { block, fillSentences, make } from '../common/dom.js';
import { millisecondsText } from '../common/numbers.js';
import type { CaseResult } from './bench_engine.js';
import { clockSentence } from './clock.js';
import { minSampleMs, type Measurement, type MeasuredScene } from './measure.js';
import { sizeText } from './request.js';

const percentText = (part: number) => `${(100 * part).toFixed(1)} %`;

/** Minimum number of rounds for a spread, as in jobs/timing/frame_statistics.hpp. */
const minRounds = 3;

/** The ratio of the smallest medians of a round, as in `tureen bench`. Null if the difference is within twice the
 *  spread; NaN if there are too few rounds. */
function ratio(timed: CaseResult, first: CaseResult, { result }: Measurement): number | null {
  if (first.frame_ms.length < minRounds) return NaN;
  const a = timed.statistics.min_of_medians, b = first.statistics.min_of_medians;
  const spread = Math.max(result.aa_spread, timed.statistics.spread, first.statistics.spread);
  return a !== b && Math.abs(a - b) >= 2 * spread * Math.min(a, b) ? a / b : null;
}

/** The text if there are at least 100 samples; with fewer, the slowest 1 % is less than one sample. */
const ofSlowest = ({ frame_ms }: CaseResult, text: string) =>
  (frame_ms.length * frame_ms[0]!.length >= 100 ? text : '–');

const counted = (count: number, what: string) => `${count} ${what}${count === 1 ? '' : 's'}`;

const ratioText = (to: number | null, { result }: Measurement) =>
  (to === null ? 'equal' : Number.isNaN(to) ? counted(result.entrants[0]!.frame_ms.length, 'round') : to.toFixed(2));

const cell = (text: string) => make('td', {}, text);

const timeColumns = [
  ['Configuration', ''], ['median', '50 % of all samples take less'], ['p95', '95 % of all samples take less'],
  ['p99', '99 % of all samples take less'], ['1 % low', 'frames per second of the slowest 1 % of samples'],
  ['ratio', 'smallest median of a round, divided by that of the first configuration'], ['stable', 'whether the times were stable after the warm-up'],
] as const;

function timesRow(timed: CaseResult, measurement: Measurement): HTMLElement {
  const { statistics: ms, name, stable } = timed, first = measurement.result.entrants[0]!;
  const to = ratio(timed, first, measurement);
  return make('tr', {}, make('th', { scope: 'row' }, name), cell(millisecondsText(ms.median)),
              cell(millisecondsText(ms.p95)), cell(ofSlowest(timed, millisecondsText(ms.p99))),
              cell(ofSlowest(timed, `${ms.low_1_percent_fps.toFixed(1)} fps`)),
              cell(timed === first ? '1' : ratioText(to, measurement)), cell(stable ? 'yes' : 'no'));
}

function timesGroup(scene: MeasuredScene, measurement: Measurement): HTMLElement {
  const { result, cameraSet } = measurement, times = result.entrants[0]!.frame_ms;
  const samples = `${counted(times[0]!.length, 'view')}, ${counted(times.length, 'round')}` +
    (result.frames_per_sample > 1 ? `, ${result.frames_per_sample} frames per view` : '');
  const title = make('th', { scope: 'rowgroup', colspan: timeColumns.length }, `${scene.name}, ${sizeText(measurement)} `,
                     make('small', {}, `${cameraSet}: ${samples}; A/A spread ${percentText(result.aa_spread)}`));
  return make('tbody', {}, make('tr', {}, title), ...result.entrants.map((timed) => timesRow(timed, measurement)));
}

export function showResults(scenes: readonly MeasuredScene[]): void {
  const titles = timeColumns.map(([name, meaning]) => make('th', { scope: 'col', title: meaning || null }, name));
  block('times').append(
    make('thead', {}, make('tr', {}, ...titles)),
    ...scenes.flatMap((scene) => scene.measurements.map((measurement) => timesGroup(scene, measurement))));
  const several = scenes.length > 1;
  const notes = scenes.flatMap(({ name, notes }) => notes.map((note) => (several ? `${name}: ${note}` : note)));
  fillSentences(block('notes'), notes);
  block('notes-part').hidden = notes.length === 0;
  block('clock').textContent = `Clock: ${clockSentence(minSampleMs())}.`;
  block('results').hidden = false;
}
