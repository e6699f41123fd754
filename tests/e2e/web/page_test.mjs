// The page against the real server, in a real browser: what a person does with it, judged by the canvas's pixels.
// usage: node page_test.mjs PATH_OF_CAUSTREAM_SERVER SOME_SCENE.glb
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { startServer } from './server.mjs';
import { openPage, openViewer } from './viewer.mjs';

const [program, glbPath] = process.argv.slice(2);
const glb = await readFile(glbPath);
let server = await startServer(program);
const viewer = await openViewer(server.url);
const { page } = viewer;
const builtin = (name) => JSON.stringify(['builtin', name]);
let failures = 0;

async function check(what, action) {
    const startMs = Date.now();
    try {
        const found = await action();
        console.log(`ok    ${what}${found ? `: ${found}` : ''} (${Date.now() - startMs} ms)`);
    } catch (error) {
        ++failures;
        console.log(`FAIL  ${what}: ${error.message}`);
    }
}

await check('the page connects and shows a picture', async () => {
    await viewer.until(() => viewer.frames > 0, 'the first frame');
    await page.selectOption('#mode', 'refined');    // which is at rest after one frame more
    await viewer.change(() => page.selectOption('#scene', builtin('sphere')));
    const picture = await viewer.look();
    const dark = picture.quantile(0.05), bright = picture.quantile(0.95);
    assert(bright > 0.05 && bright > 1.5 * dark, `the picture is flat: ${dark} to ${bright}`);
    assert.match(await viewer.text('status'), /^Connected: /);
    return viewer.text('status');
});

await check('the picture has a caustic, far brighter than what surrounds it', async () => {
    // A fixed exposure from here on: the automatic one would follow the light and hide what moves.
    await viewer.until(async () => (await viewer.text('stages')) !== '', 'the first statistics');
    await page.uncheck('#auto-exposure');
    const ev = Number(await page.inputValue('#exposure'));
    await viewer.change(() => viewer.slide('exposure', ev - 1));
    const picture = await viewer.look();
    const middle = picture.quantile(0.5), brightest = picture.quantile(0.998);
    assert(brightest > 2.5 * middle, `median ${middle}, brightest ${brightest}`);
    return `${(brightest / middle).toFixed(1)} times the median`;
});

await check('dragging the light to the right moves the caustic to the left', async () => {
    const before = await viewer.look();
    await viewer.change(() => viewer.drag([0.4, 0.5], [0.15, 0], { shift: true }));
    const after = await viewer.look();
    const cameTo = after.centroid((i) => after.luminance[i] - before.luminance[i]);
    const wentFrom = before.centroid((i) => before.luminance[i] - after.luminance[i]);
    assert(cameTo.sum > 1 && wentFrom.sum > 1, 'the picture hardly changed');
    assert(cameTo.x < wentFrom.x - 0.02, `light came to ${cameTo.x.toFixed(3)}, went from ${wentFrom.x.toFixed(3)}`);
    return `from ${wentFrom.x.toFixed(2)} to ${cameTo.x.toFixed(2)} of the width`;
});

await check('the latency from mouse to picture is measured', async () => {
    await viewer.until(async () => /ms$/.test(await viewer.text('latency')), 'a latency');
    return viewer.text('latency');
});

await check('the camera orbits and zooms, and Reset takes it back', async () => {
    const before = await viewer.look();
    await viewer.change(() => viewer.drag([0.5, 0.6], [0.2, 0.05]));
    const turned = await viewer.look();
    assert(turned.difference(before) > 0.005, 'the drag changed nothing');
    await viewer.change(async () => {
        await page.mouse.wheel(0, -300);
    });
    assert((await viewer.look()).difference(turned) > 0.005, 'the wheel changed nothing');
    await viewer.change(() => page.click('#reset'));
    assert((await viewer.look()).difference(turned) > 0.005, 'Reset changed nothing');
});

await check('one wavelength is white, the spectrum in dispersive glass is coloured', async () => {
    await viewer.change(() => viewer.slide('cauchy-b', 0.5));
    const many = await viewer.look();
    await viewer.change(() => viewer.slide('wavelengths', 1));
    const one = await viewer.look();
    const bright = many.quantile(0.99);
    const coloured = many.colourfulness(bright), plain = one.colourfulness(bright);
    assert(coloured > 2 * plain, `colour ${coloured}, with one wavelength ${plain}`);
    await viewer.change(() => viewer.slide('wavelengths', 0));   // continuous again
    return `colour ${coloured.toFixed(3)} against ${plain.toFixed(3)}`;
});

await check('another scene is another picture', async () => {
    const sphere = await viewer.look();
    await viewer.change(() => page.selectOption('#scene', builtin('gem')));
    const changed = (await viewer.look()).difference(sphere);
    assert(changed > 0.01, `the pictures differ by ${changed} only`);
});

await check('the spectral map is shown, in colour and one band of it', async () => {
    const composite = await viewer.look();
    await viewer.change(() => page.selectOption('#target', 'spectral'));
    const map = await viewer.look();
    assert.equal(map.width, map.height, 'it has not the map\'s shape');
    assert(map.quantile(0.999) > 2 * map.quantile(0.5), 'it has no caustic in it');
    await viewer.change(() => page.selectOption('#band', '0'));
    assert((await viewer.look()).difference(map) > 0.001, 'the band looks like the whole');
    await viewer.change(() => page.selectOption('#target', 'composite'));
    assert((await viewer.look()).difference(composite) < 0.01, 'the picture did not come back');
});

await check('a traced picture shows how far it has converged, and that it has', async () => {
    await viewer.slide('target-error', 0.83);    // 8 %
    await page.selectOption('#map-size', '256');
    await page.selectOption('#mode', 'traced');
    await viewer.until(() => page.isVisible('#convergence'), 'a progress bar');
    assert.match(await viewer.text('convergence-line'), /^Converging to 8\.\d %: .+ photons, error about .+ %\.$/);
    const early = await page.$eval('#convergence', (bar) => bar.value);
    assert(early < 1, `it began at ${early}`);
    await viewer.until(() => viewer.lastFlags === 5, 'a still that has converged');
    await viewer.until(async () => /^Converged/.test(await viewer.text('convergence-line')), 'the page to say so');
    assert(await page.isHidden('#convergence'), 'the bar stayed');
    const line = await viewer.text('convergence-line');
    await page.selectOption('#map-size', '512');
    await viewer.change(() => page.selectOption('#mode', 'refined'));
    assert(await page.isHidden('#convergence-line'), 'what does not converge has nothing to say');
    return line;
});

await check('a saved picture is a PNG of the size on the screen', async () => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
    const bytes = await readFile(await download.path());
    assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
    const size = { width: bytes.readUInt32BE(16), height: bytes.readUInt32BE(20) };
    assert.deepEqual(size, await page.$eval('#picture', ({ width, height }) => ({ width, height })));
    return `${download.suggestedFilename()}, ${size.width} x ${size.height}, ${bytes.length} bytes`;
});

await check('a GLB that is cut short is refused with a sentence, and the stream goes on', async () => {
    const cut = glb.subarray(0, Math.floor(glb.length / 2));
    await page.setInputFiles('#file', { name: 'cut.glb', mimeType: 'model/gltf-binary', buffer: cut });
    await viewer.until(() => page.isVisible('#problem'), 'an error');
    const sentence = await viewer.text('problem');
    assert.match(sentence, /^cut\.glb: .{10,}\.$/);
    await viewer.change(() => viewer.drag([0.5, 0.6], [0.1, 0]));
    return sentence;
});

await check('a whole GLB is uploaded and shown', async () => {
    const before = await viewer.look();
    await viewer.change(() => page.setInputFiles('#file', { name: 'mine.glb', mimeType: 'model/gltf-binary', buffer: glb }));
    assert((await viewer.look()).difference(before) > 0.01, 'the picture is the old one');
    assert.match(await page.inputValue('#scene'), /^\["asset","[0-9a-f]{64}"\]$/);
    return viewer.text('status');
});

await check('the server restarts: the page comes back by itself, and sends the file again', async () => {
    const scene = await page.inputValue('#scene');
    const before = await viewer.look();
    await server.stop();
    await viewer.until(async () => /No connection|Reconnecting/.test(await viewer.text('status')), 'the loss to be shown');
    await viewer.change(async () => (server = await startServer(program, server.port)));
    assert.equal(await page.inputValue('#scene'), scene);
    const changed = (await viewer.look()).difference(before);
    assert(changed < 0.01, `the picture is another: ${changed}`);
    return viewer.text('status');
});

await check('the server is killed: what is moved meanwhile is not lost, and nobody clicks', async () => {
    await viewer.change(() => viewer.drag([0.5, 0.6], [0.1, 0]));
    const before = await viewer.look();
    await server.stop('SIGKILL');
    await viewer.until(() => page.isVisible('#notices'), 'the loss to be shown');
    assert.match(await viewer.text('notices'), /^Reconnecting/);
    assert((await viewer.look()).difference(before) < 1e-6, 'the last picture is gone');
    await viewer.drag([0.5, 0.6], [0.12, 0]);
    await viewer.change(async () => (server = await startServer(program, server.port)));
    const turned = (await viewer.look()).difference(before);
    assert(turned > 0.005, `the picture is as it was: ${turned}`);
    await viewer.change(() => viewer.drag([0.62, 0.6], [-0.12, 0]));
    const back = (await viewer.look()).difference(before);
    assert(back < 0.3 * turned, `the picture is another: ${back}, turned ${turned}`);
    assert(await page.isHidden('#notices'), await viewer.text('notices'));
    return `turned ${turned.toFixed(3)}, back ${back.toFixed(4)}`;
});

await check('where a frame\'s time goes is told, in the window\'s words', async () => {
    const rows = await page.$$eval('#frame tr', (all) => all.map((row) => [row.cells[0].textContent, row.cells[1].textContent]));
    assert.deepEqual(rows.map(([name]) => name),
        ['hold', 'render', 'encode', 'send', 'decode', 'quality', 'picture', 'payload', 'window', 'dropped', 'photons']);
    const told = Object.fromEntries(rows);
    assert.match(told.render, /^[\d.]+ ms$/);
    assert.match(told.quality, /^(level \d, JPEG \d+|without loss)$/);
    assert.match(told.picture, /^\d+ x \d+/);
    assert.match(await viewer.text('age'), /^[\d.]+ ms$/);
    return `${told.quality}, ${told.picture}, age ${await viewer.text('age')}`;
});

await check('a second viewer follows the scene with a camera of its own, and says so', async () => {
    // As on a page that is not secure: it may not copy.
    await page.evaluate(() => Object.defineProperty(navigator, 'clipboard', { value: undefined }));
    await page.click('#copy-link');
    const link = await page.inputValue('#link');
    assert.match(link, /\?srv=[^#]+#follow=[0-9a-f]{32}$/);
    const second = await openPage(viewer.browser, link);
    await second.until(() => second.frames > 0 && second.rests(), 'its picture');
    assert.equal(await second.page.inputValue('#scene'), await page.inputValue('#scene'));
    assert.match(await second.text('session'), /^Follows session [0-9a-f]{8}/);
    assert(await second.page.isDisabled('#light-x') && (await second.page.isHidden('#mode-light')), 'it offers what it cannot do');
    const before = await second.look();
    const x = Number(await page.inputValue('#light-x'));
    await second.change(() => viewer.slide('light-x', x - 0.4));
    const lit = await second.look();
    assert(lit.difference(before) > 0.005, 'the light is the old one');
    await second.until(async () => Math.abs(Number(await second.page.inputValue('#light-x')) - (x - 0.4)) < 0.01, 'its slider');
    await second.change(() => second.drag([0.5, 0.6], [0.2, 0]));
    assert((await second.look()).difference(lit) > 0.005, 'its camera does not turn');
    assert.deepEqual(second.complaints, []);
    await second.page.close();
    return link.replace(/^.*\?/, '?');
});

await check('nothing was reported on the browser console', async () => {
    assert.deepEqual(viewer.complaints, []);
});

await viewer.browser.close();
await server.stop();
console.log(failures ? `${failures} checks failed` : 'all checks passed');
process.exit(failures ? 1 : 0);
