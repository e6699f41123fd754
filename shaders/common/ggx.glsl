// Walter et al. 2007, Microfacet Models for Refraction, Eq. 33-34, with Smith's masking as Heitz 2014 joins it. Pi times
// the reflected radiance per irradiance across the light's direction (cosine included): the unit of the camera's images.
vec3 highlight(vec3 normal, vec3 toEye, vec3 toLight, float roughness, vec3 F0) {
    float alpha2 = pow(max(roughness, 0.08), 4.0);  // below 0.08 the peak is sharper than pixels can hold
    vec3 halfway = normalize(toEye + toLight + 1e-6 * normal);
    float NdotL = max(dot(normal, toLight), 0.0), NdotV = max(dot(normal, toEye), 1e-3);
    float NdotH = max(dot(normal, halfway), 0.0), VdotH = max(dot(toEye, halfway), 0.0);
    float base = NdotH * NdotH * (alpha2 - 1.0) + 1.0;
    float D = alpha2 / (base * base);  // times pi
    float V = 0.5 / max(NdotL * sqrt(NdotV * NdotV * (1.0 - alpha2) + alpha2) +
                        NdotV * sqrt(NdotL * NdotL * (1.0 - alpha2) + alpha2), 1e-4);
    vec3 F_Schlick = F0 + (1.0 - F0) * pow(1.0 - VdotH, 5.0);
    return F_Schlick * min(D * V * NdotL, 50.0);
}
