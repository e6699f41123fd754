// The readings: rates, how wrong the map is, the server's stage times, its plan, and where the light went.

import { Encoding } from './frame.js';

const byId = (id) => document.getElementById(id);
const kLedger = [
    ['deposited', 'Reached a surface'],
    ['absorbed', 'Absorbed in glass'],
    ['reflected', 'Reflected away'],
    ['total_reflection', 'Totally reflected'],
    ['rejected', 'Found no exact hit'],
    ['left_map', 'Left the map'],
    ['no_receiver', 'Met no surface'],
    ['cut', 'Too faint, or too many bounces'],
];

function cell(text, className = '') {
    const td = document.createElement('td');
    td.textContent = text;
    td.className = className;
    return td;
}

function row(...cells) {
    const tr = document.createElement('tr');
    tr.append(...cells);
    return tr;
}

function bar(value, max, label) {
    const meter = document.createElement('meter');
    meter.max = Math.max(max, 1e-9);
    meter.value = value;
    meter.setAttribute('aria-label', label);
    const td = cell('', 'bar');
    td.append(meter);
    return td;
}

const milliseconds = (ms) => `${ms < 10 ? ms.toFixed(1) : ms.toFixed(0)} ms`;
const perCent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;
const words = (name) => name.replaceAll('_', ' ');

// 8,214; 412 thousand; 1.2 million; 3.4 billion.
function count(number) {
    if (number >= 999_950_000) return `${(number / 1e9).toFixed(1)} billion`;
    if (number >= 999_500) return `${(number / 1e6).toFixed(1)} million`;
    if (number >= 10_000) return `${(number / 1e3).toFixed(0)} thousand`;
    return number.toLocaleString('en');
}

// convergence: of the picture on the screen, while it rests; nothing: it moves, or has nothing to converge.
export function showConvergence(convergence) {
    const bar = byId('convergence'), line = byId('convergence-line');
    bar.hidden = !convergence || convergence.converged;
    bar.value = convergence?.progress ?? 0;
    line.hidden = !convergence;
    if (!convergence) return;
    const state = convergence.converged ? 'Converged' : `Converging to ${perCent(convergence.target)}`;
    line.textContent = `${state}: ${count(convergence.photons)} photons, error about ${perCent(convergence.error)}.`;
}

export function showRates({ fps, ageMs, roundTripMs, latencyMs }) {
    byId('fps').textContent = fps ? `${fps} /s` : 'at rest';
    for (const [id, ms] of [['age', ageMs], ['round-trip', roundTripMs], ['latency', latencyMs]]) {
        byId(id).textContent = ms === null ? '–' : milliseconds(ms);
    }
}

const kFixedLevel = 255, kScaled = 2;

// "level 3, JPEG 60", "fixed, JPEG 90", "without loss": as the native clients have it (client/connection/readings.h).
function qualityText({ encoding, level, jpegQuality }) {
    if (encoding !== Encoding.jpeg) return 'without loss';
    return `${level === kFixedLevel ? 'fixed' : `level ${level}`}, JPEG ${jpegQuality}`;
}

function sizeText({ flags, width, height, viewWidth, viewHeight }) {
    return `${width} x ${height}${flags & kScaled ? `, shown at ${viewWidth} x ${viewHeight}` : ''}`;
}

function dropsText({ replaced = 0, outdated = 0 } = {}) {
    return [[replaced, 'replaced'], [outdated, 'outdated']].filter(([n]) => n).map(([n, cause]) => `${n} ${cause}`).join(', ') || 'none';
}

// A frame is on the screen: where its time went, and what it is like. The window's readout has the same words.
export function showFrame(frame) {
    const sentMs = newest.send_ms;
    const facts = [
        ['hold', milliseconds(frame.holdUs / 1000)],
        ['render', milliseconds(frame.renderUs / 1000)],
        ['encode', milliseconds(frame.encodeUs / 1000)],
        ['send', sentMs === undefined ? '–' : milliseconds(sentMs)],
        ['decode', milliseconds(frame.decodeMs)],
        ['quality', qualityText(frame)],
        ['picture', sizeText(frame)],
        ['payload', `${(frame.payload.byteLength / 1000).toFixed(0)} kB`],
        ['window', `${newest.window ?? '–'} frames`],
        ['dropped', dropsText(newest.drops)],
        ['photons', count(newest.photons ?? 0)],
    ];
    byId('frame').tBodies[0].replaceChildren(...facts.map(([name, value]) => row(cell(name), cell(value, 'number'))));
}

let newest = {};

// stats: the server's message of that name.
export function showStats(stats) {
    newest = stats;
    const stages = [...(stats.stages ?? []), { pass: 'encode', ms: stats.encode_ms ?? 0 }];
    const longest = Math.max(...stages.map((stage) => stage.ms));
    byId('stages').tBodies[0].replaceChildren(...stages.map(({ pass, ms }) =>
        row(cell(words(pass)), bar(ms, longest, `${words(pass)} ${milliseconds(ms)}`), cell(milliseconds(ms), 'number'))));

    byId('choice').textContent = stats.choice ?? '';
    showError(stats.error);
    byId('server-line').textContent = (stats.warnings ?? []).join(' ');

    byId('plan').tBodies[0].replaceChildren(...(stats.plan ?? []).map((entry) => {
        const tr = row(cell(words(entry.pass)), cell(entry.run ? 'run' : 'skip', 'verdict'),
            cell([entry.reason, ...(entry.without ?? []).map((part) => `without ${part}`)].join('; ')));
        tr.className = entry.run ? 'run' : 'skip';
        return tr;
    }));
    if (stats.ledger) showLedger(stats.ledger);
}

// error: nothing when there is no map to judge.
function showError(error) {
    byId('map-error').textContent = error ? perCent(error.total) : '–';
    byId('error-line').textContent = error
        ? `Estimated error of the map: ${perCent(error.sampling)} from too few photons, ${perCent(error.spectral)} from too few wavelengths.`
        : '';
}

function showLedger(ledger) {
    const whole = ledger.on_casters;
    const share = (flux) => (whole > 0 ? `${((100 * flux) / whole).toFixed(1)} %` : '–');
    byId('energy').tBodies[0].replaceChildren(...kLedger.map(([key, label]) =>
        row(cell(label), bar(ledger[key] ?? 0, whole, `${label} ${share(ledger[key] ?? 0)}`), cell(share(ledger[key] ?? 0), 'number'))));
}
