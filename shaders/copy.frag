#version 330 core
// Copies the picture pixel by pixel.

uniform sampler2D source;

out vec4 color;

void main() {
    color = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
