// The page: ties connection, document, picture, controls and readings together.
import { Connection, sentence } from './connection.js';
import { attachControls } from './controls.js';
import { Files } from './files.js';
import { followed, showSession } from './follow.js';
import { parseFrame } from './frame.js';
import { Notices } from './notices.js';
import { Panel } from './panel.js';
import { dragLight, orbit, pan, project, zoom } from './poses.js';
import { Recorder } from './recorder.js';
import { showConvergence, showFrame, showRates, showStats } from './readout.js';
import { Rest } from './rest.js';
import { Session } from './session.js';
import { View } from './view.js';

const byId = (id) => document.getElementById(id);
const stage = byId('stage'), canvas = byId('picture');
const kResizeQuietMs = 200, kProblemMs = 9000, kRatesEveryMs = 400;
const kMaxPixelRatio = 2;
const kSoftwarePixels = 300_000;    // what a server without a GPU draws fast enough to drag; a still may wait
const kFallbackLimits = { frame_min_side: 16, frame_max_side: 4096, frame_pixels: 8_300_000 };

let welcome = null, lightMode = false, roundTripMs = null, newestStats = null;
let stale = false;    // the panel shows an older document

const rest = new Rest();
const notices = new Notices(byId('notices'));
const connection = new Connection(socketUrl(), {
    hello: () => ({ ...session.introduction(), ...(sessionStorage.token ? { token: sessionStorage.token } : {}) }),
    forget: () => session.forget(),
    welcome: (message) => start(message),
    state: (message) => takeState(message),
    frame: (buffer, recvUs) => receiveFrame(buffer, recvUs),
    'stream.info': (info) => panel.streamInfo(info),
    'asset.credit': (message) => files.credit(message),
    stats: (stats) => { showStats(stats); panel.exposure(stats.exposure_ev ?? 0); newestStats = stats; },
    status: (message) => notices.take(message),
    refused: (error) => problem(sentence(error)),
    roundTrip: (sentUs, serverUs, receivedUs) => {
        const ms = (receivedUs - sentUs) / 1000;
        roundTripMs = roundTripMs === null ? ms : 0.7 * roundTripMs + 0.3 * ms;
        view.age.pong(sentUs, serverUs, receivedUs);
    },
    link: (state, why, waitMs) => showLink(state, why, waitMs),
});
const session = new Session(connection, {
    changed: () => (stale = true),
    refused: (error) => problem(sentence(error)),
}, followed);
const recorder = new Recorder(connection, { status, refused: (error) => problem(sentence(error)) });
const view = new View(canvas, {
    ack: (fields) => connection.send({ op: 'ack', ...fields }),
    failed: (error) => problem(sentence(error)),
    painted: (frame) => { stage.classList.remove('away'); rest.painted(frame); showFrame(frame); },
});
const panel = new Panel(session, view);
const files = new Files(connection, session, { status, problem, added: (sha256, name) => panel.addUploaded(sha256, name) });

function socketUrl() {
    return `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws${location.search}`;
}

// ---- connection ----

async function start(message) {
    welcome = message;
    newestStats = null;
    rest.reset();
    files.limits = message.limits;
    view.reset();
    panel.welcome(message);
    notices.clear();
    showSession(message, status);
    status(connectedText());
    try {
        // A file that this server will not have is no reason to be without a picture.
        await files.restore(message.missing_assets ?? []).catch((error) => { if (error.code === 'lost') throw error; problem(sentence(error)); });
        await session.replay(message);
        requestSize();
        await connection.request('stream.start', { stats: true });
        if (document.hidden) connection.request('stream.pause').catch(() => {});
        recorder.welcome(message);
        files.resume();
    } catch (error) {
        if (error.code !== 'lost') problem(sentence(error));
    }
}

let warned = '';
function takeState(message) {
    session.resolve(message);
    const warnings = (message.scene.warnings ?? []).join(' ');
    if (warnings !== warned) problem(warnings);    // once a scene, not with every change of a followed one
    warned = warnings;
}

function showLink(state, why, waitMs) {
    stage.classList.toggle('away', state !== 'open');
    byId('sign-in').hidden = state !== 'auth';
    byId('ended').hidden = state !== 'ended';
    if (state === 'open') return problem('');
    roundTripMs = null;
    session.lost();
    files.lost();
    recorder.lost();
    notices.clear();
    if (state === 'retry') {
        const when = waitMs < 1000 ? '' : ` in ${(waitMs / 1000).toFixed(1)} s`;
        status(`Reconnecting${when}`);
        notices.take({ key: 'connection', level: 'warning', message: `Reconnecting${when}: ${why}` });
        return;
    }
    status('Not connected');
    if (state === 'ended') byId('ended-why').textContent = why;
    if (state === 'auth') byId('token').focus();
}

function connectedText() {
    return `Connected: ${welcome.gpu}`;
}

function status(text) {
    byId('status').textContent = text;
}

let problemTimer = 0;
function problem(text) {
    clearTimeout(problemTimer);
    byId('problem').textContent = text;
    byId('problem').hidden = !text;
    if (text) problemTimer = setTimeout(() => (byId('problem').hidden = true), kProblemMs);
}

// ---- picture ----

function receiveFrame(buffer, recvUs) {
    try {
        const frame = parseFrame(buffer);
        view.show(frame, recvUs);
        files.frame(frame);
    } catch (error) {
        problem(sentence(error));
    }
}

// The size the stage has on this screen, within what the server can draw and the limits it announced.
function requestSize() {
    if (!welcome) return;
    const limits = { ...kFallbackLimits, ...welcome.limits };
    const software = /llvmpipe|softpipe|swrast|software/i.test(welcome.gpu);
    const pixelRatio = Math.min(devicePixelRatio, kMaxPixelRatio);
    const wanted = { width: stage.clientWidth * pixelRatio, height: stage.clientHeight * pixelRatio };
    const most = Math.min(limits.frame_pixels, software ? kSoftwarePixels : Infinity);
    const shrink = Math.min(1, Math.sqrt(most / (wanted.width * wanted.height)), limits.frame_max_side / Math.max(wanted.width, wanted.height));
    const fit = (side) => Math.max(limits.frame_min_side, 2 * Math.floor((side * shrink) / 2));
    const stream = { width: fit(wanted.width), height: fit(wanted.height) };
    if (stream.width !== session.shown.stream?.width || stream.height !== session.shown.stream?.height) session.change({ stream });
}

let resizeTimer = 0;
new ResizeObserver(() => {
    clearTimeout(resizeTimer);
    resizeTimer = setTimeout(requestSize, kResizeQuietMs);
}).observe(stage);

// ---- gestures ----

const moveCamera = (move) => session.shown.camera?.eye && session.pose({ camera: poseOf(move(session.shown.camera)) });
const poseOf = ({ eye, target, up }) => ({ eye, target, up });

function moveLight(dx, dy) {
    const light = panel.light();
    if (followed || !light || !session.shown.camera?.eye) return;
    const pose = dragLight(light, session.shown.camera, session.lightPath(panel.lightName), dx, dy);
    session.pose({ lights: { [panel.lightName]: pose } });
    byId('hint').hidden = true;    // whoever has found out need not be told
}

function setLightMode(on) {
    lightMode = on && !followed;
    stage.classList.toggle('light', lightMode);
    byId('mode-light').setAttribute('aria-pressed', lightMode);
    byId('mode-camera').setAttribute('aria-pressed', !lightMode);
    showLamp();
}

// A mark where the light is, while it is what a drag moves.
function showLamp() {
    const lamp = byId('lamp'), light = panel.light(), { camera, stream } = session.shown;
    const usable = lightMode && light?.position && light.type !== 'directional' && camera?.eye && stream?.target === 'composite';
    const at = usable && project(light.position, camera, canvas.width / canvas.height);
    lamp.hidden = !at || at.some((fraction) => fraction < 0 || fraction > 1);
    if (lamp.hidden) return;
    const scale = Math.min(stage.clientWidth / canvas.width, stage.clientHeight / canvas.height);
    lamp.style.left = `${stage.clientWidth / 2 + (at[0] - 0.5) * canvas.width * scale}px`;
    lamp.style.top = `${stage.clientHeight / 2 + (at[1] - 0.5) * canvas.height * scale}px`;
}

const commands = {
    light: () => setLightMode(true), camera: () => setLightMode(false), reset: () => session.goHome(), save: () => files.savePicture(canvas),
};
attachControls(canvas, {
    orbit: (dx, dy) => moveCamera((camera) => orbit(camera, dx, dy)),
    pan: (dx, dy) => moveCamera((camera) => pan(camera, dx, dy)),
    zoom: (factor) => moveCamera((camera) => zoom(camera, factor)),
    light: moveLight,
    command: (name) => commands[name](),
    dragging: (on) => stage.classList.toggle('dragging', on),
}, () => lightMode);
byId('mode-camera').onclick = commands.camera;
byId('mode-light').onclick = commands.light;
byId('reset').onclick = commands.reset;
byId('save').onclick = commands.save;
byId('again').onclick = () => connection.connect();

byId('sign-in').onsubmit = (event) => {
    event.preventDefault();
    sessionStorage.token = byId('token').value;
    connection.connect();
};

// A hidden page paints nothing, so it must not hold the server's window.
document.addEventListener('visibilitychange', () => {
    if (connection.ready) connection.request(document.hidden ? 'stream.pause' : 'stream.resume').catch(() => {});
});

function everyFrame() {
    session.sendPose(performance.now());
    view.paint();
    if (stale) {
        stale = false;
        panel.refresh();
        showLamp();
    }
    showConvergence(connection.ready && newestStats && rest.shows(newestStats.frame_seq) ? newestStats.convergence : null);
    requestAnimationFrame(everyFrame);
}
requestAnimationFrame(everyFrame);
setInterval(() => showRates({ fps: view.framesPerSecond(), ageMs: view.age.ms, roundTripMs, latencyMs: view.latencyMs() }), kRatesEveryMs);
connection.connect();
