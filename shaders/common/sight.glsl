// What one sees along a ray that meets no caster: a receiver or the environment. Receivers are met triangle by triangle;
// one that the camera sees at that place has the picture's colour, textures and all, any other is shaded from what is
// known of it. Expects surfaces.glsl and receiver_shading.glsl.
uniform View u_view;                  // the camera's
uniform vec2 u_shift;                 // uv: how far the picture's samples lie from the pixels' middles
uniform sampler2D u_background;       // linear radiance of the receivers
uniform sampler2D u_receiversDepth;   // layer value
uniform samplerBuffer u_receivers;    // two texels an object: base colour and roughness; emissive and metallic

// Whether the camera sees this point of a receiver, and at what place of its picture.
bool onPicture(vec3 pos, vec3 normal, out vec2 uv) {
    uv = viewToUv(u_view, pos) + u_shift;
    if (any(greaterThanEqual(abs(uv - 0.5), vec2(0.5))) || (u_view.perspective && -pos.z < u_view.near)) return false;
    // From the same side; and in the texel's middle the depth is that of the point's own plane.
    vec3 toEye = u_view.perspective ? -pos : vec3(0.0, 0.0, 1.0);
    vec2 size = vec2(textureSize(u_receiversDepth, 0)), texel = floor(uv * size);
    float layer = layerOf(u_view, pos);
    float there = layer + dot(layerGradient(u_view, pos, normal), (texel + 0.5) / size - uv);
    float off = abs(texelFetch(u_receiversDepth, ivec2(texel), 0).r - there);
    return dot(toEye, normal) > 0.0 && off < 5e-3 * (u_view.perspective ? layer : 1.0);
}

// `t`: how far away it is.
vec3 sightAlong(vec3 origin, vec3 direction, out float t) {
    Ground ground = nearestReceiver(origin, direction);
    t = ground.t;
    if (ground.object < 0) return u_environment;
    Receiver at;
    at.world = origin + t * direction;
    at.normal = dot(ground.geometric, direction) > 0.0 ? -ground.geometric : ground.geometric;
    vec3 pos = (u_view.worldToView * vec4(at.world, 1.0)).xyz;
    vec2 uv;
    if (onPicture(pos, mat3(u_view.worldToView) * at.normal, uv)) return textureLod(u_background, uv, 0.0).rgb;

    vec4 base = texelFetch(u_receivers, 2 * ground.object), emissive = texelFetch(u_receivers, 2 * ground.object + 1);
    at.base = base.rgb;
    at.emissive = emissive.rgb;
    at.roughness = base.a;
    at.metallic = emissive.a;
    at.gloss = 0.0;      // a highlight is where the camera sees it
#if SHADOW
    at.shadow = (u_shadowView.worldToView * vec4(at.world, 1.0)).xyz;
    at.shadowNormal = mat3(u_shadowView.worldToView) * at.normal;
#endif
#if MAP
    at.map = (u_mapView.worldToView * vec4(at.world, 1.0)).xyz;
#endif
    return shade(at);
}

// The key light itself, seen along a ray that nothing stops before `t`: a tight lobe of bounded height.
vec3 lampAlong(vec3 origin, vec3 direction, float t) {
    vec4 to = towardsLight(u_lights[0], origin);
    float lobe = exp(-900.0 * (1.0 - dot(direction, to.xyz)));  // about 3 degrees across
    bool hidden = !u_lights[0].directional && t * t * to.w < 1.0;
    vec3 irradiance = u_lights[0].rgb * to.w * cone(u_lights[0], to.xyz);
    return hidden ? vec3(0.0) : min(irradiance, vec3(4.0)) * (60.0 * lobe);
}
