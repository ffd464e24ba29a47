#version 330 core
// Checkerboard whose cells keep their size on the screen at any zoom.

uniform vec2 origin;  // of the frame, in whole framebuffer pixels, so that no pixel lies between two cells
uniform float cell;   // framebuffer pixels
uniform vec3 even, odd;

out vec4 color;

void main() {
    vec2 index = floor((gl_FragCoord.xy - origin) / cell);
    color = vec4(mod(index.x + index.y, 2.0) < 0.5 ? even : odd, 1.0);
}
