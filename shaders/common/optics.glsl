// Snell and Fresnel at a smooth dielectric, unpolarised. Twin of server/optics/fresnel.h. eta = n_i / n_t; `d` travels
// towards the surface, `n` is the unit normal against it.

// False at total internal reflection; else the refracted unit direction and the reflectance.
bool refractDielectric(vec3 d, vec3 n, float eta, out vec3 refracted, out float reflectance) {
    float cosI = clamp(-dot(d, n), 0.0, 1.0);
    float sin2T = eta * eta * (1.0 - cosI * cosI);
    reflectance = 1.0;
    refracted = vec3(0.0);
    if (sin2T >= 1.0) return false;
    float cosT = sqrt(1.0 - sin2T);
    refracted = normalize(eta * d + (eta * cosI - cosT) * n);
    float s = (eta * cosI - cosT) / (eta * cosI + cosT);
    float p = (cosI - eta * cosT) / (cosI + eta * cosT);
    reflectance = 0.5 * (s * s + p * p);
    return true;
}
