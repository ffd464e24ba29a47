#version 330 core
// A line of one color.

uniform vec4 line_color;  // straight alpha
uniform float width;      // framebuffer pixels

in float offset;

out vec4 color;  // premultiplied

void main() {
    float alpha = line_color.a * clamp(0.5 * width + 0.5 - abs(offset), 0.0, 1.0);
    color = vec4(line_color.rgb * alpha, alpha);
}
