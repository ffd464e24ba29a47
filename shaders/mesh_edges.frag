#version 330 core
// A dark hairline with a faint light halo: one of the two is visible on any picture.

in float offset;
flat in float strength;

out vec4 color;  // premultiplied

const vec3 DARK = vec3(0.05, 0.07, 0.12);
const vec3 LIGHT = vec3(0.85, 0.93, 1.0);

void main() {
    float dark = 0.6 * clamp(1.0 - abs(offset), 0.0, 1.0);
    float light = 0.3 * clamp(2.0 - abs(offset), 0.0, 1.0) * (1.0 - dark);
    color = vec4(DARK * dark + LIGHT * light, dark + light) * strength;
}
