// Pictures of numbers: sRGB code values in 0..1, meant for eyes only.

// A layer value spans decades (near over depth): eighteen stops from dim far to bright near; 0 is nothing.
vec3 layerColour(float layer) {
    return layer > 0.0 ? vec3(clamp(1.0 + log2(layer) / 18.0, 0.05, 1.0)) : vec3(0.0);
}

// Four stops around `middle`, near bright and far dim; 0 is nothing.
vec3 distanceColour(float distance, float middle) {
    return distance > 0.0 ? vec3(clamp(0.5 + 0.25 * log2(middle / distance), 0.05, 1.0)) : vec3(0.0);
}

// Neighbouring numbers are far apart on the colour wheel: steps of the golden ratio.
vec3 labelColour(float label) {
    vec3 hue = abs(fract(0.618034 * label + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0;
    return label > 0.0 ? mix(vec3(1.0), clamp(hue, 0.0, 1.0), 0.7) : vec3(0.0);
}

// Each channel: 1 is mid grey, a factor of 64 to white and to black.
vec3 logColour(vec3 value) { return clamp(0.5 + log2(max(value, 1e-6)) / 12.0, 0.0, 1.0); }
