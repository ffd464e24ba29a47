#version 330 core
// Converts premultiplied to straight alpha, rounded to 1/255; a pixel that rounds to alpha 0 has no color.

uniform sampler2D source;

out vec4 color;

void main() {
    vec4 premultiplied = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    vec4 straight = vec4(premultiplied.rgb / max(premultiplied.a, 1e-6), premultiplied.a);
    straight = floor(clamp(straight, 0.0, 1.0) * 255.0 + 0.5);
    color = straight.a == 0.0 ? vec4(0.0) : straight / 255.0;
}
