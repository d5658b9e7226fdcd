// The report page: shows the results in #data, a list of {file, folder, kind, data}. `data` is the output
// of a command (docs/json.md), or the list of lines of a training log. `folder` is the address of the
// file's folder; images are relative to it. All data are untrusted: they become text, never HTML.
'use strict';

// -- numbers and names -----------------------------------------------------------------------------
const known = (value) => typeof value === 'number' && Number.isFinite(value);
const number = (write) => (value) => known(value) ? write(value) : '–';
const fixed = (digits) => number((value) => value.toFixed(digits));
const count = number((value) => Math.round(value).toLocaleString('en'));
const percent = number((value) => (100 * value).toFixed(1));
const times = number((value) => `${value.toFixed(value < 10 ? 2 : 1)}×`);
const small = number((value) => value === 0 ? '0' : value.toExponential(1));
const db = fixed(2);
const signed = (write) => (value) => known(value) && value >= 0 ? `+${write(value)}` : write(value);
/** Three significant digits down to a microsecond, as in the terminal (ms_text in cli/table.cpp). */
const ms = number((value) => value.toFixed(value < 1 ? 3 : value < 10 ? 2 : 1));
const any = number((value) => Number.isInteger(value) ? count(value)
  : Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6 ? value.toExponential(2) : String(+value.toPrecision(4)));
const geometricMean = (values) => Math.exp(values.reduce((sum, each) => sum + Math.log(each), 0) / values.length);
const unique = (values) => [...new Set(values)];
/** The first value of each key. */
const firstOfEach = (values, key) => values.filter((value, i) => values.findIndex((other) => key(other) === key(value)) === i);
const base = (path) => String(path).split(/[\\/]/).pop();
const stem = (entry) => base(entry.file).replace(/\.\w+$/, '');
const folderName = (entry) => base(entry.file.replace(/[\\/][^\\/]*$/, ''));
const isBaseline = (name) => name === 'published' || name === 'baseline';
/** Whether a linear axis would hide the smallest of these values. */
const spansDecades = (values) => Math.min(...values) > 0 && Math.max(...values) > 8 * Math.min(...values);

/** Labels from the first description that is unique for each entry. */
function labels(entries, ...describe) {
  const all = [...describe, (entry) => entry.file, (entry, i) => `${entry.file} ${i + 1}`].map((each) => entries.map(each));
  return all.find((names) => unique(names).length === names.length && names.every(Boolean));
}

// -- elements --------------------------------------------------------------------------------------
function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) key in made ? made[key] = value : made.setAttribute(key, value);
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}
const paragraph = (text, className = '') => element('p', { className }, text);
const list = (lines) => lines?.length ? element('ul', {}, lines.map((line) => element('li', {}, line))) : null;
const fold = (title, ...children) => element('details', {}, element('summary', {}, title), ...children);
const cards = (...all) => element('div', { className: 'cards' }, all.filter(Boolean).map(([figure, words]) =>
  element('div', { className: 'card' }, element('strong', {}, figure), element('span', {}, words))));
const facts = (all) => element('dl', {}, all.filter(([, value]) => value !== undefined && value !== null && value !== '')
  .flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));

/**
 * Columns are [heading with its unit, value of a row, format of a number]. Columns without values are
 * hidden. A click on a heading sorts the rows.
 */
function table(label, columns, rows, isStrong = () => false) {
  if (!rows.length) return null;
  const used = columns.filter(([, value]) => rows.some((row) => value(row) !== undefined && value(row) !== null && value(row) !== ''));
  const body = element('tbody', {}, rows.map((row) => element('tr', { className: isStrong(row) ? 'strong' : '' },
    used.map(([, value, write]) => element('td', { className: write ? 'number' : '' },
      typeof value(row) === 'string' ? value(row) : write ? write(value(row)) : String(value(row) ?? ''))))));
  const lines = [...body.children].map((line, i) => ({ line, row: rows[i] }));
  const head = used.map(([heading, value, write]) => {
    const cell = element('th', { className: write ? 'number' : '', scope: 'col' }, element('button', {
      onclick() {
        const direction = cell.getAttribute('aria-sort') === 'ascending' ? 'descending' : 'ascending';
        for (const each of head) each.removeAttribute('aria-sort');
        cell.setAttribute('aria-sort', direction);
        const sign = direction === 'ascending' ? 1 : -1;
        const rank = ({ row }) => known(value(row)) ? value(row) : Infinity;
        lines.sort((a, b) => sign * (write ? rank(a) - rank(b) || 0 : String(value(a.row)).localeCompare(String(value(b.row)))));
        body.append(...lines.map(({ line }) => line));
      },
    }, heading));
    return cell;
  });
  return element('div', { className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': label },
    element('table', {}, element('thead', {}, element('tr', {}, head)), body));
}

// -- plots -----------------------------------------------------------------------------------------
const hasPlots = typeof Chart !== 'undefined';
const drawn = [];  // draw functions of all plots, to redraw them when the colours change
const dots = ['circle', 'rect', 'triangle', 'rectRot', 'star', 'crossRot'];

/**
 * `x`, `y`: titles of the axes. `series`: {name, points: [{x, y, name}]}; `line` joins the points, `dash`
 * draws a horizontal level without points. `names` instead of `x` gives bars, and `points` are their
 * heights. Axes are logarithmic if values span decades; `linear` keeps the x axis linear.
 */
function plot(title, { x, names, y, series, linear }) {
  const present = series.filter(({ points }) => points.length);
  if (!hasPlots || !present.length) return null;
  const canvas = element('canvas', { role: 'img', 'aria-label': `Plot: ${title}` });
  const values = (axis) => present.filter(({ dash }) => !dash).flatMap(({ points }) => points.map((p) => names ? p : p[axis])).filter(known);
  let chart;
  const draw = () => {
    const style = getComputedStyle(document.documentElement), color = (name) => style.getPropertyValue(name).trim();
    Object.assign(Chart.defaults, { color: color('--faint'), borderColor: color('--line'), animation: false, maintainAspectRatio: false });
    Chart.defaults.font.family = style.getPropertyValue('font-family') || 'system-ui';
    const axis = (text, which) => {
      const log = spansDecades(values(which)) && !(linear && which === 'x');
      const isRound = (value) => [1, 2, 5].some((digit) => Math.abs(value / 10 ** Math.floor(Math.log10(value) + 1e-9) - digit) < 1e-6);
      return {
        type: log ? 'logarithmic' : 'linear', grace: log || which === 'x' ? 0 : '5%', title: { display: true, text },
        ticks: log ? { callback: (value, i, all) => all.length < 10 || isRound(value) ? any(value) : null } : values(which).every(Number.isInteger) ? { precision: 0 } : {},
      };
    };
    chart?.destroy();
    chart = new Chart(canvas, {
      type: names ? 'bar' : 'scatter',
      data: {
        labels: names,
        datasets: present.map(({ name, points, line, dash }, i) => ({
          label: name, data: points, showLine: Boolean(line || dash), borderWidth: 2, borderDash: dash ? [5, 5] : [],
          pointRadius: dash || points.length > 60 ? 0 : points.length > 25 ? 2 : 4, pointHoverRadius: dash ? 0 : 6, pointStyle: dash ? 'line' : dots[i % dots.length],
          borderColor: color(`--c${i % 8}`), backgroundColor: color(`--c${i % 8}`),
        })),
      },
      options: {
        interaction: { mode: 'nearest', intersect: false },
        scales: { x: names ? {} : axis(x, 'x'), y: axis(y, 'y') },
        plugins: {
          legend: { display: present.length > 1, labels: { usePointStyle: true, boxHeight: 7 } },
          tooltip: {
            filter: ({ dataset }) => !dataset.borderDash.length,
            callbacks: { label: ({ dataset, raw, label }) => names ? `${dataset.label}: ${any(raw)}` : `${raw.name ?? dataset.label}: ${any(raw.x)}, ${any(raw.y)}` },
          },
        },
      },
    });
  };
  drawn.push(draw);
  return element('figure', {}, element('h3', {}, title), element('div', { className: 'canvas' }, canvas));
}
const plots = (...all) => element('div', { className: 'plots' }, all.flat().filter(Boolean));
const images = (all, className = '') => all.length ? element('div', { className: `images ${className}` }, all.map(([address, caption]) => element('figure', {},
  element('a', { href: address }, element('img', { src: address, alt: caption, loading: 'lazy' })), element('figcaption', {}, caption)))) : null;
const imageAddress = (entry, path) => entry.folder + encodeURIComponent(base(path));

/** "15,000 triangles", "20,000 splats", or both. */
const primitives = ({ triangles, splats }) => [(triangles || !splats) && `${count(triangles)} triangles`, splats && `${count(splats)} splats`].filter(Boolean).join(' and ');

// -- common parts of all results -------------------------------------------------------------------
function provenance({ scene, machine, device, program, date, protocol, notes }) {
  const quoted = (program?.arguments ?? []).map((word) => /^[\w\-./:,=@+%]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  return fold('Measurement conditions', facts([
    ['scene', scene && `${scene.name} (${scene.path}), ${primitives(scene)}, ${scene.appearance}`],
    ['renderer', device && device.renderer + (device.software ? ' (software)' : '')], ['driver', device?.version], ['context', device?.context],
    ['machine', machine && [machine.cpu, machine.cores && `${machine.cores} cores`, machine.memory_mib && `${count(machine.memory_mib)} MiB`,
      machine.rasteriser_threads && `${machine.rasteriser_threads} rasteriser threads`].filter(Boolean).join(', ')],
    ['times', protocol?.clock], ['date', date], ['program', program && `tureen ${program.version}, commit ${program.commit}${program.build ? `, ${program.build} build` : ''}`],
    ['command', quoted.length ? element('code', {}, `tureen ${quoted.join(' ')}`) : ''],
  ]), list(notes));
}
const subtitle = ({ scene, device, date }) => paragraph([scene && primitives(scene), device?.renderer,
  device?.software && 'software renderer: not comparable with a GPU', date?.slice(0, 10)].filter(Boolean).join(' · '), 'faint');

// -- tureen bench ----------------------------------------------------------------------------------
const place = (m) => `${m.camera_set}, ${m.size}`;
const best = (m) => m.frame_ms?.min_of_medians;

/** Speed of `m` relative to `other`: a number, or a word if noise hides it (verdict_on in jobs/timing/frame_statistics.hpp). */
function speedup(m, other) {
  if (!other || m === other) return other ? 1 : undefined;
  const rounds = Math.min(m.rounds, other.rounds), smaller = Math.min(best(m), best(other));
  if (rounds < 3) return `${rounds} round${rounds === 1 ? '' : 's'}`;
  const spread = Math.max(m.frame_ms.spread, other.frame_ms.spread, m.aa_spread, other.aa_spread);
  return Math.abs(best(m) - best(other)) < 2 * spread * smaller ? 'equal' : best(other) / best(m);
}

function showBench(entry) {
  const { data } = entry, all = data.measurements, first = all[0].configuration;
  const names = unique(all.map((m) => m.configuration));
  const reference = names.find(isBaseline) ?? names.find((name) => name === 'generic') ?? first;
  const at = (name, m) => all.find((each) => each.configuration === name && place(each) === place(m));
  const own = all.filter((m) => m.configuration === first), largest = own.reduce((a, b) => b.width * b.height >= a.width * a.height ? b : a);
  const ratios = own.map((m) => speedup(m, at(reference, m))).filter(known);
  const sets = unique(all.map((m) => m.camera_set));
  const range = ratios.length > 1 ? ` (${times(Math.min(...ratios))} to ${times(Math.max(...ratios))})` : '';
  return [
    subtitle(data),
    cards(
      reference !== first && (ratios.length ? [times(geometricMean(ratios)), `as fast as ${isBaseline(reference) ? `the baseline (${reference})` : reference}${range}`]
        : [String(speedup(largest, at(reference, largest)) ?? '–'), `no significant difference from ${reference}`]),
      [`${ms(best(largest))} ms`, `per frame: ${first}, ${place(largest)}`], [`${fixed(largest.fps < 100 ? 1 : 0)(largest.fps)} FPS`, `mean of ${count(largest.frames)} frames`],
      data.load && [`${fixed(1)(data.load.device_mib)} MiB`, 'on the device']),
    plots(sets.map((set) => {
      const here = all.filter((m) => m.camera_set === set);
      if (unique(here.map((m) => m.size)).length < 2) return null;
      return plot(`Frame time by size: ${set}`, { x: 'pixels', y: 'best time per frame (ms)', series: names.map((name) => ({
        name, line: true, points: here.filter((m) => m.configuration === name).map((m) => ({ x: m.width * m.height, y: best(m), name: `${name}, ${m.size}` })) })) });
    }), largest.views_ms?.length > 1 ? plot(`Frame time by view: ${place(largest)}`, { x: 'view', y: 'median time per frame (ms)',
      series: names.map((name) => ({ name, line: true, points: (at(name, largest)?.views_ms ?? []).map((y, i) => ({ x: i + 1, y, name })) })) }) : null),
    table('Frame times', [
      ['configuration', (m) => m.configuration + (m.stable === false ? ' †' : '')], ['cameras', (m) => m.camera_set], ['size', (m) => m.size],
      ['best (ms)', best, ms], [`× ${reference}`, (m) => speedup(m, at(reference, m)), fixed(2)], ['median (ms)', (m) => m.frame_ms.median, ms], ['mean (ms)', (m) => m.frame_ms.mean, ms], ['p95 (ms)', (m) => m.frame_ms.p95, ms],
      ['p99 (ms)', (m) => m.frame_ms.p99, ms], ['GPU (ms)', (m) => m.gpu_ms, ms], ['FPS', (m) => m.fps, fixed(1)], ['1 % low (FPS)', (m) => m.low_1_percent_fps, fixed(1)],
      ['rounds', (m) => m.rounds, count], ['spread (%)', (m) => m.rounds < 3 ? '–' : m.frame_ms.spread, percent], ['A/A (%)', (m) => m.aa_spread, percent],
    ], all, (m) => m.configuration === first),
    paragraph('Best is the smallest median of a round; ratios use it. "equal": the difference is below twice the spread.', 'faint'),
    all.some((m) => m.stable === false) ? paragraph('† The times were not stable after the warm-up.', 'faint') : null,
    ...(data.comparison ? [element('h3', {}, `Against ${data.comparison.against}`), list([...data.comparison.circumstances, ...data.comparison.unmatched]),
      table('Comparison', [['configuration', (r) => r.configuration], ['cameras', (r) => r.camera_set], ['size', (r) => r.size], ['then (ms)', (r) => r.then_ms, ms],
        ['now (ms)', (r) => r.now_ms, ms], ['now / then', (r) => r.ratio, fixed(3)], ['spread (%)', (r) => r.spread, percent], ['verdict', (r) => r.verdict],
        ['image', (r) => r.same_pixels ? 'same' : 'different']], data.comparison.ratios)] : []),
    table('Times of passes (device clock)', [['configuration', (r) => r.m.configuration], ['cameras', (r) => r.m.camera_set], ['size', (r) => r.m.size],
      ['pass', (r) => r.pass], ['time (ms)', (r) => r.ms, ms]], all.flatMap((m) => (m.passes_ms ?? []).map((pass) => ({ m, ...pass })))),
    list(firstOfEach(all.filter((m) => m.passes_gap !== 'one_pass' && m.passes_reason), (m) => m.passes_gap).map((m) => `Times of passes are incomplete or missing: ${m.passes_reason}`)),
    images(all.filter((m) => m.picture).map((m) => [imageAddress(entry, m.picture), `${m.configuration}, ${place(m)}: last timed frame`]), 'small'),
    fold('Configurations', (data.configurations ?? []).map(({ name, options, plan, plan_ms, upload_ms, device_mib }) => [element('h3', {}, name),
      paragraph(`${options?.length ? `tureen render ${options.join(' ')}: ` : ''}plan ${ms(plan_ms)} ms, upload ${ms(upload_ms)} ms, ${fixed(1)(device_mib)} MiB on the device`), list(plan)]).flat()),
    provenance(data),
  ];
}

/** Several results of bench, one per column. */
function showBenches(entries) {
  const names = labels(entries, stem, folderName, (e) => `${stem(e)}, ${e.data.scene.name}`);
  const key = ({ scene }, m) => [scene.name, primitives(scene), place(m), m.configuration].join('\n');
  const rows = new Map();
  entries.forEach(({ data }, i) => data.measurements.forEach((m) => {
    if (!rows.has(key(data, m))) rows.set(key(data, m), { scene: data.scene, m, of: [] });
    rows.get(key(data, m)).of[i] = best(m);
  }));
  const shared = [...rows.values()].filter(({ of }) => Object.keys(of).length > 1).slice(0, 24);
  return [
    plots(plot('Best time per frame', { names: shared.map(({ m }) => `${m.configuration}, ${m.size}`), y: 'best time per frame (ms)',
      series: names.map((name, i) => ({ name, points: shared.map(({ of }) => of[i] ?? null) })) })),
    table('Best time per frame', [['configuration', (r) => r.m.configuration], ['size', (r) => r.m.size], ...names.map((name, i) => [`${name} (ms)`, (r) => r.of[i], ms]),
      ['cameras', (r) => r.m.camera_set], ['scene', (r) => r.scene.name], ['primitives', (r) => primitives(r.scene)]], [...rows.values()]),
    list(entries.map(({ data }, i) => `${names[i]}: ${data.device.renderer}${data.device.software ? ' (software renderer: not comparable with hardware)' : ''}; ${data.machine.cpu}; commit ${data.program.commit}`)),
  ];
}

// -- tureen tradeoff -------------------------------------------------------------------------------
const isPlain = (c) => c.method === 'tureen';
/** The Pareto front: points without a faster point that has at least the same decibels. */
const front = (points) => [...points].sort((a, b) => a.x - b.x || b.y - a.y).filter((p, i, all) => all.slice(0, i).every((faster) => faster.y < p.y));

function errorPlot(title, x, y, configurations, time, error, onFront, levels = []) {
  const points = (filter) => configurations.filter((c, i) => known(time(c)) && known(error(c)) && filter(c, i)).map((c) => ({ x: time(c), y: error(c), name: c.name }));
  const xs = configurations.map(time).filter(known);
  return plot(title, { x, y, series: [
    { name: 'Pareto front', line: true, points: points(onFront).sort((a, b) => a.x - b.x) },
    { name: 'other settings', points: points((c, i) => isPlain(c) && !onFront(c, i)) },
    { name: 'without specialisation', points: points((c) => c.method === 'tureen --no-specialise') },
    { name: 'baseline', points: points((c) => isBaseline(c.method)) },
    ...levels.filter(([, level]) => known(level)).map(([name, level]) => ({ name, dash: true, points: [{ x: Math.min(...xs), y: level }, { x: Math.max(...xs), y: level }] })),
  ] });
}

function showTradeoff(entry) {
  const { data } = entry, { drawing, choice, limits } = data, defaults = drawing.configurations[0];
  const baseline = drawing.configurations.find((c) => isBaseline(c.method)), chosen = choice && drawing.configurations[choice.configuration];
  const panel = (title, panel, words) => [
    element('h3', {}, title), paragraph(words, 'faint'),
    plots(errorPlot(`${title}: error against time`, 'best time per frame (ms)', 'PSNR (dB)', panel.configurations, (c) => c.ms, (c) => c.e_render.psnr_db, (c) => c.on_front,
      [['reference in 8 bits (R1)', panel.r1?.psnr_db], ['limit', panel === drawing ? limits?.least_psnr_db : null]])),
    table(title, [['configuration', (c) => c.name], ['method', (c) => c.method], ['best (ms)', (c) => c.ms, ms], ['p95 (ms)', (c) => c.ms_p95, ms], ['MiB', (c) => c.mib, fixed(1)],
      ['PSNR (dB)', (c) => c.e_render.psnr_db, db], ['exact (dB)', (c) => c.e_render_exact?.psnr_db, db], ['max', (c) => c.e_render.max, fixed(3)], ['99.9 %', (c) => c.e_render.p999, fixed(4)],
      ['SSIM', (c) => c.e_render.ssim, fixed(4)], ['FLIP', (c) => c.e_render.flip, fixed(4)], ['coverage', (c) => c.e_render.coverage, small],
      ['', (c) => c === chosen ? 'choice' : c.on_front ? 'front' : '']], panel.configurations, (c) => c === chosen),
    table('Settings', [['setting', (k) => k.title], ['slowest / fastest', (k) => k.time_ratio, fixed(2)], ['best − worst (dB)', (k) => k.psnr_range_db, db], ['matters', (k) => k.matters ? 'yes' : '']], panel.knobs),
    list([...panel.notes, ...panel.skipped.map(({ name, reason }) => `Not measured: ${name}: ${reason}`), ...panel.configurations.flatMap((c) => c.warnings.map((warning) => `${c.name}: ${warning}`))]),
  ];
  const photographed = [...drawing.configurations, ...data.antialiasing.configurations].filter((c) => c.e_model);
  return [
    subtitle(data),
    cards(
      baseline && [times(baseline.ms / defaults.ms), `as fast as the baseline: ${ms(defaults.ms)} ms instead of ${ms(baseline.ms)} ms`],
      chosen ? [`${ms(chosen.ms)} ms`, `the choice: ${chosen.name}${chosen === defaults ? '' : `, ${times(defaults.ms / chosen.ms)} as fast as the defaults`}`] : ['no choice', `no configuration reaches ${limits?.least_psnr_db} dB`],
      [`${db((chosen ?? defaults).e_render.psnr_db)} dB`, `error of ${chosen ? 'the choice' : 'the defaults'} against the reference`],
      photographed[0] && [`${db(photographed[0].e_model.psnr_db)} dB`, `the defaults against ${data.e_model?.photographs} photographs`]),
    ...panel('Drawing settings', drawing, `Error against the reference image of the same model, ${reference(data)}.`),
    ...panel('Antialiasing settings', data.antialiasing, 'Error against the reference image with 8 × 8 samples per pixel.'),
    ...(photographed.length ? [element('h3', {}, 'Against photographs'), paragraph('This is the error of the model, not of drawing. Do not compare it with the errors above.', 'faint'),
      plots(errorPlot('Photographs: error against time', 'best time per frame (ms)', 'PSNR against photographs (dB)', photographed, (c) => c.ms, (c) => c.e_model.psnr_db, (c) => c.on_front)),
      table('Against photographs', [['configuration', (c) => c.name], ['method', (c) => c.method], ['PSNR (dB)', (c) => c.e_model.psnr_db, db],
        ['against the defaults (dB)', (c) => c.e_model.psnr_db - photographed[0].e_model.psnr_db, fixed(3)], ['SSIM', (c) => c.e_model.ssim, fixed(4)], ['FLIP', (c) => c.e_model.flip, fixed(4)]], photographed)] : []),
    provenance(data),
  ];
}

/** How the reference of the drawing settings was drawn. */
function reference({ protocol, scene }) {
  const exact = protocol.samples === 'exact';
  if (scene.splats) return exact ? 'in exact order of the splats' : 'in the order of the splats\' centres';
  return exact ? 'with exact triangles' : 'at the device\'s sample points';
}

/** The configuration of a panel with this method and these settings; undefined if the panel has none. */
function findWay(panel, method, settings) {
  const own = (key) => panel.knobs.find((knob) => knob.key === key)?.settings[0];
  return panel.configurations.find((c) => c.method === method && Object.keys({ ...c.knobs, ...settings }).every((key) => c.knobs[key] === (settings[key] ?? own(key))));
}

/** Several results of tradeoff: the configurations that all scenes have, with means. */
function showTradeoffs(entries) {
  const names = labels(entries, (e) => e.data.scene.name, stem, folderName);
  const joined = (title, key) => {
    const panels = entries.map(({ data }) => data[key]);
    const ways = new Map();
    for (const panel of panels) for (const c of panel.configurations) {
      const asked = Object.entries(c.knobs).filter(([knob, value]) => value !== panel.knobs.find((each) => each.key === knob)?.settings[0]).sort();
      ways.set(JSON.stringify([c.method, asked]), { name: c.name, method: c.method, of: panels.map((each) => findWay(each, c.method, Object.fromEntries(asked))) });
    }
    const rows = [...ways.values()].filter(({ of }) => of.every(Boolean)).map((way) => {
      const ratios = way.of.map((c, i) => c.ms / panels[i].configurations[0].ms), errors = way.of.map((c) => c.e_render.psnr_db), worst = Math.min(...errors);
      return { ...way, ratios, time: way.of.every((c) => known(c.ms)) ? geometricMean(ratios) : null, mean: errors.reduce((a, b) => a + b) / errors.length, worst, where: names[errors.indexOf(worst)] };
    });
    const shown = new Set(front(rows.filter((r) => isPlain(r) && known(r.time)).map((r) => ({ x: r.time, y: r.mean, r }))).map(({ r }) => r));
    const baseline = rows.find((r) => isBaseline(r.method));
    return [
      element('h3', {}, title),
      baseline && cards([times(baseline.time), `as fast as the baseline: geometric mean of ${names.length} scenes`]),
      plots(errorPlot(`${title}: error against time, means`, 'time relative to the defaults', 'mean PSNR (dB)', rows, (r) => r.time, (r) => r.mean, (r) => shown.has(r))),
      table(title, [['configuration', (r) => r.name], ['method', (r) => r.method], ['time / defaults', (r) => r.time, fixed(3)], ['mean (dB)', (r) => r.mean, db], ['worst (dB)', (r) => r.worst, db],
        ['worst in', (r) => r.where], ['', (r) => shown.has(r) ? 'front' : ''], ...names.flatMap((name, i) => [[`${name} (ms)`, (r) => r.of[i].ms, ms], [`${name} (dB)`, (r) => r.of[i].e_render.psnr_db, db]])], rows),
      rows.length < ways.size ? paragraph(`${ways.size - rows.length} configurations are omitted, because some scenes lack them.`, 'faint') : null,
    ];
  };
  return [paragraph('Times are geometric means of the scenes\' ratios to their defaults. Errors are means of decibels.', 'faint'), ...joined('Drawing settings', 'drawing'), ...joined('Antialiasing settings', 'antialiasing')];
}

// -- tureen train and eval -------------------------------------------------------------------------
function showTrainings(entries) {
  const names = labels(entries, stem, folderName);
  const runs = entries.map(({ data }, i) => ({ name: names[i], data, last: data.at(-1), test: data.findLast((r) => known(r.test_psnr_db))?.test_psnr_db }));
  // The trainer measures at most five views while it trains (trainer/common/session.cpp).
  const heldOut = ([{ plan }]) => [`${plan ? Math.min(plan.test_views, 5) : 'some'} held-out views`, plan && `${plan.width} × ${plan.height}`,
    plan?.input && `--scale ${plan.input.scale}`, 'one sample per pixel'].filter(Boolean).join(', ');
  const best = runs.reduce((a, b) => (b.test ?? -1) > (a.test ?? -1) ? b : a);
  const curve = (title, x, y, get, at) => plot(title, { x, y, linear: true, series: runs.map(({ name, data }) => ({ name, line: true, points: data.filter((r) => known(get(r))).map((r) => ({ x: at(r), y: get(r), name })) })) });
  const seconds = (r) => r.seconds, steps = (r) => r.step, primitives = (r) => r.triangles ?? r.splats;
  return [
    cards([`${db(best.test)} dB`, `on ${heldOut(best.data)}${runs.length > 1 ? `: ${best.name}` : ''}`], [count(best.last.step), `steps in ${any(best.last.seconds)} s`],
      [count(primitives(best.last)), best.last.splats === undefined ? 'triangles' : 'splats'], [`${any(best.last.step / best.last.seconds)}`, 'steps per second']),
    plots(curve('Held-out views', 'training time (s)', 'PSNR (dB)', (r) => r.test_psnr_db, seconds), curve('Loss', 'step', 'loss', (r) => r.loss, steps),
      curve('Training views', 'step', 'PSNR (dB)', (r) => r.train_psnr_db, steps), curve('Primitives', 'step', 'triangles or splats', primitives, steps)),
    table('Trainings', [['run', (r) => r.name], ['steps', (r) => r.last.step, count], ['time (s)', (r) => r.last.seconds, any], ['held-out (dB)', (r) => r.test, db], ['measured on', (r) => heldOut(r.data)], ['training views (dB)', (r) => r.last.train_psnr_db, db],
      ['loss', (r) => r.last.loss, fixed(4)], ['SSIM', (r) => r.last.ssim, fixed(4)], ['triangles or splats', (r) => primitives(r.last), count], ['steps per second', (r) => r.last.step / r.last.seconds, any], ['not finite', (r) => r.last.non_finite, count]], runs),
  ];
}

function showEvals(entries) {
  const names = labels(entries, (e) => base(e.data.scene ?? ''), stem, folderName);
  const one = entries.length === 1, figures = [['PSNR (dB)', 'psnr_db', db], ['SSIM', 'ssim', fixed(4)], ['FLIP', 'flip', fixed(4)]];
  const views = unique(entries.flatMap(({ data }) => data.views.map((v) => v.name)));
  const of = (i, name) => entries[i].data.views.find((v) => v.name === name);
  const words = (each) => [`mean of ${each.views.length} views (${each.split})`, known(each.scale) && `--scale ${each.scale}`,
    known(each.samples_per_pixel) && `${each.samples_per_pixel} sample${each.samples_per_pixel === 1 ? '' : 's'} per pixel`].filter(Boolean).join(', ');
  // Of two scenes, the difference of each figure: the second minus the first.
  const columns = (get) => [...entries.flatMap((_, i) => figures.map(([head, key, write]) => [one ? head : `${names[i]}: ${head}`, (row) => get(row, i)?.[key], write])),
    ...(entries.length === 2 ? figures.map(([head, key, write]) => [`difference: ${head}`, (row) => get(row, 1)?.[key] - get(row, 0)?.[key], signed(write)]) : [])];
  const winner = entries.reduce((a, b) => b.data.mean.psnr_db > a.data.mean.psnr_db ? b : a), { mean, renderer } = winner.data;
  return [
    cards([`${db(mean.psnr_db)} dB`, `PSNR, ${words(winner.data)}${one ? '' : `: ${names[entries.indexOf(winner)]}`}`], [fixed(4)(mean.ssim), `SSIM (${winner.data.ssim_border})`],
      known(mean.flip) && [fixed(4)(mean.flip), 'FLIP']),
    one ? null : table('Means', [['result', (i) => names[i]], ['measured on', (i) => words(entries[i].data)], ...figures.map(([head, key, write]) => [head, (i) => entries[i].data.mean[key], write])], entries.map((_, i) => i)),
    !one && unique(entries.map(({ data }) => words(data))).length > 1 ? paragraph('These results have different views, scales or samples: their figures cannot be compared.', 'error') : null,
    plots(views.length > 1 ? plot('PSNR by view', { names: views, y: 'PSNR (dB)', series: entries.map((_, i) => ({ name: names[i], points: views.map((name) => of(i, name)?.psnr_db ?? null) })) }) : null),
    table('Views', [['view', (name) => name], ...columns((name, i) => of(i, name))], views),
    ...entries.map((entry) => images((entry.data.pairs ?? []).map((path, k) => [imageAddress(entry, path),
      `${entry.data.views[k].name}: photograph, ${names.join(', ')}, difference of these two`]), 'wide')),
    ...entries.flatMap((entry, i) => [images(entry.data.views.map((v, k) => [v, entry.data.output?.[k]]).filter(([, path]) => path)
      .map(([v, path]) => [imageAddress(entry, path), `${one ? '' : `${names[i]}: `}${v.name}, ${db(v.psnr_db)} dB: photograph, rendering, difference`]))]),
    fold('Drawing conditions', facts([['scene', winner.data.scene], ['photographs', winner.data.dataset], ['renderer', renderer], ['context', winner.data.context]]), list(winner.data.plan)),
  ];
}

// -- ./dev: tables of any measurements -------------------------------------------------------------
const units = { ms: 'ms', ns: 'ns', s: 's', db: 'dB', mib: 'MiB', mb: 'MB', kb: 'kB', bytes: 'bytes', fps: 'FPS' };
const heading = (key) => {
  const [, words, unit] = key.match(/^(.*?)(?:_(ms|ns|s|db|mib|mb|kb|bytes|fps))?$/);
  return words.replaceAll('_', ' ') + (unit ? ` (${units[unit]})` : '');
};
function showMeasurements({ data }) {
  return [
    paragraph([data.date?.slice(0, 10), data.machine?.cpu, data.commit && `commit ${data.commit}`].filter(Boolean).join(' · '), 'faint'),
    plots((data.plots ?? []).flatMap(({ table: name, x, y, each }) => {
      const rows = data.tables[name] ?? [];
      return (each ? unique(rows.map((row) => row[each])) : [undefined]).map((value) => plot([name, value].filter((part) => part !== undefined).join(': '), {
        x: heading(x), y: y.length === 1 ? heading(y[0]) : '', series: y.map((key) => ({ name: heading(key), line: true,
          points: rows.filter((row) => (!each || row[each] === value) && known(row[x]) && known(row[key])).map((row) => ({ x: row[x], y: row[key] })) })) }));
    })),
    ...Object.entries(data.tables).flatMap(([name, rows]) => [element('h3', {}, name), table(name, unique(rows.flatMap(Object.keys)).map((key) => {
      const isNumber = rows.some((row) => known(row[key]));
      return [heading(key), (row) => row[key], isNumber ? any : undefined];
    }), rows)]),
  ];
}

// -- the page --------------------------------------------------------------------------------------
/** By kind: the title of one result, and the functions for one result and for several together. */
const kinds = {
  bench: { title: ({ data }) => `Frame times: ${data.scene.name}`, one: showBench, together: showBenches, all: 'Frame times side by side' },
  tradeoff: { title: ({ data }) => `Error against time: ${data.scene.name}`, one: showTradeoff, together: showTradeoffs, all: 'Error against time over all scenes' },
  training: { title: (entry) => `Training: ${stem(entry)}`, together: showTrainings, all: 'Trainings' },
  eval: { title: (entry) => `Against photographs: ${base(entry.data.scene ?? entry.file)}`, together: showEvals, all: 'Against photographs' },
  measurements: { title: ({ data }) => `Measurements: ${data.name}`, one: showMeasurements },
};

function showAll(entries) {
  const sections = [];
  const add = (title, show) => {
    let content;
    try { content = show(); } catch (error) { content = [paragraph(`This result cannot be displayed: ${error.message}`, 'error')]; }
    sections.push([title, content]);
  };
  for (const [kind, { title: titleOf, one, together, all }] of Object.entries(kinds)) {
    const own = entries.filter((entry) => entry.kind === kind);
    const title = (entry) => own.some((other) => other !== entry && titleOf(other) === titleOf(entry)) ? `${titleOf(entry)} (${entry.file})` : titleOf(entry);
    if (together && own.length > (one ? 1 : 0)) add(own.length > 1 ? all : title(own[0]), () => together(own));
    if (one) for (const entry of own) add(title(entry), () => one(entry));
  }
  const single = sections.length === 1, name = single ? sections[0][0] : `${entries.length} results`;
  document.title = `${name} – Tureen`;
  document.querySelector('#report').replaceChildren(element('h1', {}, name),
    single ? '' : element('nav', { 'aria-label': 'Results' }, sections.map(([title], i) => element('a', { href: `#part${i}` }, title))),
    hasPlots ? '' : paragraph('Plots are missing: this program was built without chart.js (Debian package libjs-chart.js).', 'faint'),
    ...sections.map(([title, content], i) => element('section', { id: `part${i}` }, single ? '' : element('h2', {}, title), ...content)));
  drawAll();
}

/// Draws all plots; an error in one does not affect the others.
function drawAll() {
  for (const draw of drawn) try { draw(); } catch (error) { console.error(error); }
}

showAll(JSON.parse(document.querySelector('#data').textContent));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawAll);
