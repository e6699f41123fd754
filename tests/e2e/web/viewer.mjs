// The page in a real browser, and what its canvas shows.
import { chromium } from 'playwright-core';

// No frame for this long: the picture has settled. A composite picture ends with a still without loss, which comes a
// while after.
const kQuietMs = 700, kQuietAfterStillMs = 250;
const kSettleMs = 60_000;    // not a wish for speed: only a sign that nothing will come
const kGridWidth = 120;
const kJpeg = 1;

export async function openViewer(url) {
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
            '--disable-component-update', '--disable-sync'],
    });
    return openPage(browser, url);
}

// Another page of the same browser.
export async function openPage(browser, url) {
    const page = await browser.newPage({ viewport: { width: 900, height: 480 } });
    const viewer = new Viewer(browser, page);
    await page.goto(url);
    return viewer;
}

class Viewer {
    constructor(browser, page) {
        this.browser = browser;
        this.page = page;
        this.frames = 0;
        this.lastFrameMs = 0;
        this.complaints = [];
        page.on('pageerror', (error) => this.complaints.push(error.message));
        page.on('console', (message) => {
            // While the server is down the browser itself reports each failed attempt to reach it.
            if (message.type() === 'error' && !/WebSocket connection to/.test(message.text())) this.complaints.push(message.text());
        });
        page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
            if (typeof payload === 'string') return;
            ++this.frames;
            this.lastFrameMs = Date.now();
            this.lastFlags = payload.readUInt32LE(16);
            this.lastIsFinal = (this.lastFlags & 1) === 1 && payload.readUInt8(13) !== kJpeg;
            this.lastIsComposite = payload.readUInt8(12) === 1;
        }));
    }

    // Does something that changes the picture, and waits until the picture has changed and rests.
    async change(action) {
        const before = this.frames;
        await action();
        await this.until(() => this.frames > before && this.rests(), 'a new picture that rests');
    }

    rests() {
        const quietMs = Date.now() - this.lastFrameMs;
        return this.lastIsComposite ? this.lastIsFinal && quietMs > kQuietAfterStillMs : quietMs > kQuietMs;
    }

    async until(condition, what) {
        const deadline = Date.now() + kSettleMs;
        while (!(await condition())) {
            if (Date.now() > deadline) throw new Error(`waited in vain for ${what}`);
            await new Promise((resolve) => setTimeout(resolve, 50));
        }
    }

    text(id) {
        return this.page.textContent(`#${id}`);
    }

    // What a range input does when a person moves it.
    slide(id, value) {
        return this.page.$eval(`#${id}`, (slider, position) => {
            slider.value = position;
            slider.dispatchEvent(new Event('input', { bubbles: true }));
        }, value);
    }

    // A real mouse over the picture; from and by are fractions of its size.
    async drag(from, by, { shift = false } = {}) {
        const { mouse, keyboard } = this.page;
        const box = await this.page.locator('#picture').boundingBox();
        const at = (share) => [box.x + box.width * (from[0] + by[0] * share), box.y + box.height * (from[1] + by[1] * share)];
        if (shift) await keyboard.down('Shift');
        await mouse.move(...at(0));
        await mouse.down();
        for (let step = 1; step <= 8; ++step) {
            await mouse.move(...at(step / 8));
            await this.page.waitForTimeout(30);
        }
        await mouse.up();
        if (shift) await keyboard.up('Shift');
    }

    // The canvas as a grid of linear RGB, box-filtered from its pixels.
    async look() {
        const { width, height, values } = await this.page.evaluate((gridWidth) => {
            const canvas = document.getElementById('picture');
            const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
            const gridHeight = Math.round((gridWidth * canvas.height) / canvas.width);
            const sums = new Float64Array(gridWidth * gridHeight * 4);
            for (let y = 0; y < canvas.height; ++y) {
                for (let x = 0; x < canvas.width; ++x) {
                    const cell = 4 * (Math.floor((y * gridHeight) / canvas.height) * gridWidth + Math.floor((x * gridWidth) / canvas.width));
                    for (let c = 0; c < 3; ++c) sums[cell + c] += (pixels[4 * (y * canvas.width + x) + c] / 255) ** 2.2;
                    ++sums[cell + 3];
                }
            }
            const means = [];
            for (let i = 0; i < sums.length; i += 4) for (let c = 0; c < 3; ++c) means.push(sums[i + c] / sums[i + 3]);
            return { width: gridWidth, height: gridHeight, values: means };
        }, kGridWidth);
        return new Picture(width, height, values);
    }
}

// Linear RGB, row by row from the top.
export class Picture {
    constructor(width, height, rgb) {
        Object.assign(this, { width, height, rgb });
        this.luminance = Array.from({ length: width * height }, (_, i) => 0.2126 * rgb[3 * i] + 0.7152 * rgb[3 * i + 1] + 0.0722 * rgb[3 * i + 2]);
    }

    // The luminance below which the share of the picture lies.
    quantile(share) {
        const sorted = [...this.luminance].sort((a, b) => a - b);
        return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
    }

    // Mean absolute difference of all channels.
    difference(other) {
        return this.rgb.reduce((sum, value, i) => sum + Math.abs(value - other.rgb[i]), 0) / this.rgb.length;
    }

    // Centre, in fractions of the picture, of where weight(i) is positive; weighted.
    centroid(weight) {
        let sum = 0, x = 0, y = 0;
        for (let i = 0; i < this.luminance.length; ++i) {
            const w = Math.max(0, weight(i));
            sum += w;
            x += w * (i % this.width);
            y += w * Math.floor(i / this.width);
        }
        return { x: x / sum / this.width, y: y / sum / this.height, sum };
    }

    // Mean spread between the channels where the picture is bright.
    colourfulness(bright) {
        let sum = 0, count = 0;
        this.luminance.forEach((value, i) => {
            if (value < bright) return;
            const channels = this.rgb.slice(3 * i, 3 * i + 3);
            sum += Math.max(...channels) - Math.min(...channels);
            ++count;
        });
        return count ? sum / count : 0;
    }
}
