// The render server under test, as its own process.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';

const kReadyMs = 60_000;

// Resolves once frames can be asked for. port 0: any free one. Returns {url, port, stop()}.
export async function startServer(program, port = 0, options = []) {
    const child = spawn(program, ['--port', String(port), '--gpu', 'software', '--log-level', 'warning', ...options], { stdio: ['ignore', 'pipe', 'pipe'] });
    process.once('exit', () => child.kill('SIGKILL'));    // however the test ends, no server stays behind
    let log = '';
    child.stderr.on('data', (text) => (log = (log + text).slice(-4000)));
    const ended = once(child, 'exit');
    const ready = new Promise((resolve, reject) => {
        createInterface({ input: child.stdout }).on('line', (line) => {
            const found = /^ready (http:\/\/\S+:(\d+)\/)/.exec(line);
            if (found) resolve({ url: found[1], port: Number(found[2]) });
        });
        ended.then(([code]) => reject(new Error(`the server ended with ${code} before it was ready:\n${log}`)));
        child.on('error', reject);
        setTimeout(() => reject(new Error(`the server was not ready after ${kReadyMs} ms:\n${log}`)), kReadyMs).unref();
    });
    const stop = async (signal = 'SIGTERM') => {
        child.kill(signal);
        await ended;
    };
    try {
        return { ...(await ready), stop, log: () => log };
    } catch (error) {
        child.kill('SIGKILL');
        throw error;
    }
}
