// Dispersion as the panel's sliders show it: Cauchy's n = A + B / l^2, l in um.

const kMaxIndex = 6, kShortestUm = 0.38;   // what the server takes, over the band it renders (protocol/README.md)
const kMaxB = 1;

// Real glass has B near 0.005, the thesis's exaggerated one 0.6: the cube gives both room on one slider.
export const bToSlider = (b) => Math.cbrt(b / kMaxB);
export const sliderToB = (position) => kMaxB * position ** 3;

// The pair as a dispersion that the server takes: B no larger than the index at the band's violet end allows.
export function cauchyWithin(a, b) {
    const mostB = (kMaxIndex - 0.001 - a) * kShortestUm ** 2;
    return ['cauchy', Number(a.toFixed(4)), Number(Math.min(b, mostB).toFixed(5))];
}

// Any dispersion as the Cauchy pair that the sliders show. Abbe: KHR_materials_dispersion's formula has Cauchy's form.
export function asCauchy(dispersion) {
    const [kind, a = 1.5, b = 0] = dispersion ?? [];
    if (kind === 'cauchy') return [a, b];
    if (kind === 'abbe') return [a - ((a - 1) / b) * 1.5168, ((a - 1) / b) * 0.523655];
    if (kind === 'sellmeier') {
        const index = (l2) => Math.sqrt(1 + [1, 2, 3].reduce((sum, i) => sum + (dispersion[i] * l2) / (l2 - dispersion[i + 3]), 0));
        const blue = 0.4861 ** 2, red = 0.6563 ** 2;   // Fraunhofer F and C
        const slope = (index(blue) - index(red)) / (1 / blue - 1 / red);
        return [index(blue) - slope / blue, slope];
    }
    return [a, 0];
}
