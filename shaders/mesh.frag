#version 330 core
// The textured mesh; the picture is premultiplied. The tint (r, g, b, share) replaces this share of its colors.

uniform sampler2D picture;
uniform float opacity;
uniform vec4 tint;
uniform bool inverted;  // opacity minus color in place of the color, for blending that multiplies

in vec2 uv;

out vec4 color;

void main() {
    color = texture(picture, uv);
    color.rgb = mix(color.rgb, tint.rgb * color.a, tint.a);
    color *= opacity;
    if (inverted) color.rgb = color.a - color.rgb;
}
