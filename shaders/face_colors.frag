#version 330 core
// One color for each face, from a scale; the picture's light and dark show through.

uniform sampler2D picture;
uniform sampler2D levels;  // one texel for each face, in drawing order: 0 to 1 on the scale, below 0 off the scale
uniform sampler2D scale;   // one row
uniform bool translucent;  // the lower the level, the more of the picture shows

const float MAX_COVER = 0.7;  // share of the picture that a translucent scale covers
const vec3 OFF_SCALE = vec3(1.0, 0.0, 0.6);

in vec2 uv;

out vec4 color;  // premultiplied

void main() {
    vec4 base = texture(picture, uv);
    int width = textureSize(levels, 0).x;
    float level = texelFetch(levels, ivec2(gl_PrimitiveID % width, gl_PrimitiveID / width), 0).r;
    float count = float(textureSize(scale, 0).x);
    vec3 tint = texture(scale, vec2((clamp(level, 0.0, 1.0) * (count - 1.0) + 0.5) / count, 0.5)).rgb;
    float light = dot(base.rgb, vec3(0.3, 0.6, 0.1));
    color = vec4((level < 0.0 ? OFF_SCALE : tint) * (0.8 * base.a + 0.2 * light), base.a);
    if (translucent) color = mix(base, color, MAX_COVER * clamp(level, 0.0, 1.0));
}
