// What an upload is checked by: SHA-256 of the whole file, CRC-32 of each chunk.

const kCrcTable = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let bit = 0; bit < 8; ++bit) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
});

// ISO 3309, as zlib's crc32().
export function crc32(bytes) {
    let crc = 0xffffffff;
    for (let i = 0; i < bytes.length; ++i) crc = kCrcTable[(crc ^ bytes[i]) & 255] ^ (crc >>> 8);
    return (crc ^ 0xffffffff) >>> 0;
}

// Lower-case hexadecimal. Browsers offer crypto.subtle to secure pages only, and a render server on the local network
// is seldom one: there the digest is computed here.
export async function sha256Hex(bytes) {
    const digest = globalThis.crypto?.subtle
        ? new Uint8Array(await crypto.subtle.digest('SHA-256', bytes))
        : sha256(bytes);
    return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}

// The first 32 fractional bits of the square and cube roots of primes (FIPS 180-4, 4.2.2 and 5.3.3). The roots are found
// in integers: a double has too few bits for the cube roots.
function rootBits(prime, power) {
    const scaled = BigInt(prime) << BigInt(32 * power);
    let low = 0n, high = 1n << 38n;
    while (high - low > 1n) {
        const middle = (low + high) >> 1n;
        if (middle ** BigInt(power) <= scaled) low = middle;
        else high = middle;
    }
    return Number(low & 0xffffffffn);
}

const kPrimes = [];
for (let n = 2; kPrimes.length < 64; ++n) if (kPrimes.every((prime) => n % prime)) kPrimes.push(n);
const kRound = Uint32Array.from(kPrimes, (prime) => rootBits(prime, 3));
const kStart = Uint32Array.from(kPrimes.slice(0, 8), (prime) => rootBits(prime, 2));

const turn = (x, n) => (x >>> n) | (x << (32 - n));

// FIPS 180-4, 6.2. Returns 32 bytes.
export function sha256(bytes) {
    const padded = new Uint8Array((((bytes.length + 8) >> 6) + 1) * 64);
    padded.set(bytes);
    padded[bytes.length] = 0x80;
    const view = new DataView(padded.buffer);
    view.setUint32(padded.length - 8, Math.floor(bytes.length / 2 ** 29));
    view.setUint32(padded.length - 4, (bytes.length << 3) >>> 0);

    const hash = Uint32Array.from(kStart), w = new Uint32Array(64);
    for (let block = 0; block < padded.length; block += 64) {
        for (let i = 0; i < 16; ++i) w[i] = view.getUint32(block + 4 * i);
        for (let i = 16; i < 64; ++i) {
            const s0 = turn(w[i - 15], 7) ^ turn(w[i - 15], 18) ^ (w[i - 15] >>> 3);
            const s1 = turn(w[i - 2], 17) ^ turn(w[i - 2], 19) ^ (w[i - 2] >>> 10);
            w[i] = w[i - 16] + s0 + w[i - 7] + s1;
        }
        let [a, b, c, d, e, f, g, h] = hash;
        for (let i = 0; i < 64; ++i) {
            const t1 = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + kRound[i] + w[i]) | 0;
            const t2 = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
            [h, g, f, e, d, c, b, a] = [g, f, e, (d + t1) | 0, c, b, a, (t1 + t2) | 0];
        }
        [a, b, c, d, e, f, g, h].forEach((value, i) => (hash[i] += value));
    }
    const digest = new DataView(new ArrayBuffer(32));
    hash.forEach((value, i) => digest.setUint32(4 * i, value));
    return new Uint8Array(digest.buffer);
}
