// What the page keeps of its document, when it comes back, and how old its frames are: without a browser.
// usage: node document_test.mjs FOLDER_OF_THE_PAGE
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const from = (file) => import(pathToFileURL(`${process.argv[2]}/${file}`));
const { Document, lacking, mergePatch } = await from('document.js');
const { Backoff, closingOf, comeBackMs } = await from('retry.js');
const { FrameAge } = await from('frame_age.js');

const toldAll = (document, has) => {
    const patches = [];
    for (let id = 100, patch; (patch = document.next(id)); ++id) patches.push(patch);
    return patches.reduce(mergePatch, has);
};

test('what a server took is resumed from, what it refused is forgotten', () => {
    const document = new Document();
    document.keep({ scene: ['builtin', 'prism'] });
    assert.deepEqual(document.next(1), { scene: ['builtin', 'prism'] });
    document.keep({ scene: ['builtin', 'nowhere'] });
    document.next(2);
    assert.deepEqual(document.wanted().scene, ['builtin', 'nowhere']);
    document.answered(1, true);
    document.answered(2, false);
    assert.deepEqual(document.taken, { scene: ['builtin', 'prism'] });
    assert.deepEqual(document.wanted(), document.taken);
});

test('what moved after a change is not undone by it', () => {
    const document = new Document();
    document.moved({ camera: { fov_y_deg: 20 } });
    document.keep({ scene: ['builtin', 'prism'], camera: null });
    document.next(1);
    document.moved({ camera: { eye: [1, 2, 3] } });
    document.answered(1, true);
    assert.deepEqual(document.taken, { scene: ['builtin', 'prism'], camera: { eye: [1, 2, 3] } });
});

test('changes go on while nobody is there, in their order', () => {
    const document = new Document();
    document.moved({ scene: ['builtin', 'sphere'], lights: { key: { position: [0, 2, 0] } } });
    document.keep({ transport: { bounces: 3 } });
    document.next(1);
    document.lost();    // 1 was never answered
    document.keep({ scene: ['builtin', 'prism'], lights: null, camera: null });
    document.keep({ lights: { sun: { direction: [0, -1, 0] } } });
    document.keep({ lights: { sun: { direction: [1, -1, 0] } } });
    document.lost();    // an attempt that failed
    const wanted = { scene: ['builtin', 'prism'], lights: { sun: { direction: [1, -1, 0] } }, transport: { bounces: 3 } };
    assert.deepEqual(document.wanted(), wanted);
    assert.deepEqual(document.taken.scene, ['builtin', 'sphere']);
    document.meet({});
    assert.deepEqual(toldAll(document, {}), wanted);
});

test('a server that has it all is told nothing, a follower changes its own only', () => {
    const document = new Document();
    document.moved({ camera: { eye: [1, 2, 3] } });
    document.lost();
    document.meet({ camera: { eye: [1, 2, 3], exposure: ['auto'] }, transport: { bounces: 8 } });
    assert.equal(document.next(1), undefined);
    document.lost();
    document.meet({ scene: ['builtin', 'gem'], camera: { eye: [0, 0, 1] } }, ['camera', 'stream']);
    assert.deepEqual(document.next(1).camera.eye, [1, 2, 3]);
    assert.equal(document.wanted().scene, undefined);
    assert.deepEqual(lacking({ a: { b: 1 } }, { a: { b: 1, c: 2 } }), { a: { c: 2 } });
});

test('lights that a scene lacks are no reason to be refused', () => {
    const document = new Document();
    document.moved({ scene: ['builtin', 'gem'], lights: { key: {}, old: {} } });
    document.prune({ scene: ['builtin', 'prism'], lights: {} });
    assert.equal(Object.keys(document.taken.lights).length, 2);
    document.prune({ scene: ['builtin', 'gem'], lights: { key: { position: [0, 1, 0] } } });
    assert.deepEqual(document.taken.lights, { key: {} });
});

test('waits double from a quarter of a second to eight, and a goaway says when', () => {
    const longest = new Backoff(), shortest = new Backoff();
    for (const bound of [250, 500, 1000, 2000, 4000, 8000, 8000]) {
        assert.equal(longest.next(1), bound);
        assert.equal(shortest.next(0), bound / 2);
    }
    longest.reset();
    assert.equal(longest.next(1), 250);
    assert.equal(comeBackMs({ reconnect_ms: 500, jitter_ms: 1000 }, 0.5), 1000);
    assert.equal(comeBackMs({}, 1), 0);
    assert.equal(comeBackMs({ reconnect_ms: 1e9 }, 1), 60_000);
    for (const code of [1001, 1006, 4408, 4429, 4500]) assert(closingOf(code).retry, code);
    for (const code of [4401, 4403, 4409, 4426]) assert(!closingOf(code).retry, code);
});

test('a frame is as old as its input, or as its change', () => {
    const age = new FrameAge();
    const frame = { inputSeq: 1, clientUs: 1000, stateRev: 1, serverUs: 9e6, holdUs: 1000, renderUs: 20_000, encodeUs: 3000 };
    age.painted(frame, 51_000);
    assert.equal(age.ms, 50);
    age.pong(990_000, 8_995_000, 1_000_000);    // the server is 8 s ahead, the way takes 5 ms
    age.pong(990_000, 9_995_000, 1_900_000);    // slower: says less
    age.painted({ ...frame, stateRev: 2 }, 1_006_000);
    assert.equal(age.ms, 30);
    age.painted({ ...frame, stateRev: 2 }, 5_006_000);    // at rest
    assert.equal(age.ms, 30);
});
