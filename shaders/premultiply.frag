#version 330 core
// Converts straight to premultiplied alpha, pixel by pixel.

uniform sampler2D source;

out vec4 color;

void main() {
    vec4 straight = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    color = vec4(straight.rgb * straight.a, straight.a);
}
