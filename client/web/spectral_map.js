// Raw float maps made visible: RGB maps in their own colours, one wavelength's band in false colour.

const kRampSteps = 1024;
const kExposureInertia = 0.75;   // how much of the old automatic gain a new frame keeps, so that it does not flicker
const kRamp = [[0, 0, 4], [66, 10, 104], [147, 38, 103], [221, 81, 58], [252, 165, 10], [252, 255, 164]];

let automaticGain = 0;

// IEEE 754 half precision, every bit pattern once.
const halfToFloat = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const magnitude = exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    halfToFloat[bits] = exponent === 31 ? 0 : bits & 0x8000 ? -magnitude : magnitude;
}

// sRGB (IEC 61966-2-1) of 0..1 in even steps of the square root, where eight bits need it fine.
const srgbRamp = new Uint8ClampedArray(kRampSteps + 1);
const falseColorRamp = Array.from({ length: kRampSteps + 1 }, (_, i) => rampColor(i / kRampSteps));
for (let i = 0; i <= kRampSteps; ++i) {
    const linear = (i / kRampSteps) ** 2;
    srgbRamp[i] = 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
}

function rampColor(t) {
    const at = t * (kRamp.length - 1), below = Math.min(Math.floor(at), kRamp.length - 2);
    return kRamp[below].map((value, c) => value + (at - below) * (kRamp[below + 1][c] - value));
}

// The samples as numbers; half floats through the table.
function samples(frame) {
    const { buffer, byteOffset, byteLength } = frame.payload;
    if (frame.sample === 1) return Float32Array.from(frame.payload, (byte) => byte / 255);
    if (frame.sample === 3) return new Float32Array(buffer, byteOffset, byteLength / 4);
    return Float32Array.from(new Uint16Array(buffer, byteOffset, byteLength / 2), (bits) => halfToFloat[bits]);
}

// Puts the brightest half per cent at white: single focused texels would leave the rest black.
function gainFor(values) {
    const picked = [];
    for (let i = 0; i < values.length; i += 37) if (values[i] > 0) picked.push(values[i]);
    if (picked.length === 0) return 1;
    picked.sort((a, b) => a - b);
    return 1 / Math.max(picked[Math.floor(picked.length * 0.995)], 1e-6);
}

// frame: encoding raw. look: {band: index, or -1 for colour}. Returns ImageData.
export function mapToImage(frame, look) {
    const values = samples(frame);
    const count = frame.width * frame.height;
    const wanted = gainFor(values);
    const jumped = wanted > 4 * automaticGain || automaticGain > 4 * wanted;
    automaticGain = jumped ? wanted : automaticGain * kExposureInertia + wanted * (1 - kExposureInertia);
    const colour = frame.bands === 3 && look.band < 0;
    const band = Math.min(Math.max(look.band, 0), frame.bands - 1);
    const pixelStep = frame.planar ? 1 : frame.bands, bandStep = frame.planar ? count : 1;

    const image = new ImageData(frame.width, frame.height);
    const out = image.data;
    const position = (value) => (value > 0 ? Math.min(kRampSteps, Math.round(kRampSteps * Math.sqrt(value * automaticGain))) : 0);
    for (let i = 0; i < count; ++i) {
        const at = i * pixelStep;
        // A spectral map's first row is its lowest.
        const to = 4 * (frame.target === 'spectral' ? count - frame.width * (1 + Math.floor(i / frame.width)) + (i % frame.width) : i);
        if (colour) {
            out[to] = srgbRamp[position(values[at])];
            out[to + 1] = srgbRamp[position(values[at + bandStep])];
            out[to + 2] = srgbRamp[position(values[at + 2 * bandStep])];
        } else {
            out.set(falseColorRamp[position(values[at + band * bandStep])], to);
        }
        out[to + 3] = 255;
    }
    return image;
}
