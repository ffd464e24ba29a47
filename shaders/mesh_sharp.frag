#version 330 core
// The textured mesh with better filters than the graphics card has; the picture is premultiplied.
// The tint (r, g, b, share) replaces this share of its colors.

uniform sampler2D picture;
uniform float opacity;
uniform vec4 tint;
uniform bool inverted;  // opacity minus color in place of the color, for blending that multiplies

in vec2 uv;

out vec4 color;

const float MAX_SAMPLES = 8.0;  // a side; beyond that, each sample is a mean of texels itself, from a mipmap
const float MAX_CUBIC_STEP = 1.5;  // texels per pixel; where more are averaged, linear samples do as well
const float SLACK = 0.15;   // texels that a pixel may be larger than its samples: then one is as good as two
const float EXACT = 1e-3;   // texels: this near to the middle of a texel, only that one counts

vec4 texel(ivec2 position) {
    return texelFetch(picture, clamp(position, ivec2(0), textureSize(picture, 0) - 1), 0);
}

vec4 catmull_rom_weights(float t) {
    return 0.5 * vec4(t * (t * (2.0 - t) - 1.0), t * t * (3.0 * t - 5.0) + 2.0,
                      t * (t * (4.0 - 3.0 * t) + 1.0), t * t * (t - 1.0));
}

// Cubic interpolation (Catmull and Rom 1974), which blurs less than a linear one; overshoots are cut off.
vec4 cubic_sample(vec2 position) {
    vec2 corner = position - 0.5;
    vec2 base = floor(corner + EXACT), t = corner - base;
    t = mix(t, vec2(0.0), lessThan(abs(t), vec2(EXACT)));
    ivec2 first = ivec2(base);
    if (t == vec2(0.0)) return texel(first);
    vec4 across = catmull_rom_weights(t.x), down = catmull_rom_weights(t.y), sum = vec4(0.0);
    for (int row = 0; row < 4; ++row) {
        vec4 line = vec4(0.0);
        for (int column = 0; column < 4; ++column)
            line += across[column] * texel(first + ivec2(column - 1, row - 1));
        sum += down[row] * line;
    }
    sum = max(sum, 0.0) / max(sum.a, 1.0);  // the color stays where alpha overshoots
    return vec4(min(sum.rgb, sum.a), sum.a);
}

// From the middle of the area to one of the count.x * count.y samples in it.
vec2 offset(ivec2 index, ivec2 count, vec2 width, vec2 across, vec2 down) {
    vec2 place = ((vec2(index) + 0.5) / vec2(count) - 0.5) * width;
    return place.x * across + place.y * down;
}

// The mean over the area of the pixel in the picture, where it is smaller than a texel the value in its middle.
// Where it is hardly more than a texel, the area is narrowed, so that the sharpness does not jump where a part
// becomes a little smaller.
vec4 sharp_sample() {
    vec2 size = vec2(textureSize(picture, 0)), across = dFdx(uv), down = dFdy(uv);
    vec2 lengths = vec2(length(across * size), length(down * size));
    float level = max(ceil(log2(max(lengths.x, lengths.y) / MAX_SAMPLES) - EXACT), 0.0);  // whole: one is read
    ivec2 count = max(ivec2(ceil(lengths / exp2(level) - SLACK)), ivec2(1));
    vec2 width = clamp(2.0 * (lengths - 1.0), 0.0, 1.0);
    // Two loops, because a processor that draws eight pixels at once computes both branches of an `if`.
    bool few = max(lengths.x, lengths.y) <= MAX_CUBIC_STEP;
    ivec2 cubic = few ? count : ivec2(0), linear = few ? ivec2(0) : count;
    vec4 sum = vec4(0.0);
    for (int row = 0; row < cubic.y; ++row)
        for (int column = 0; column < cubic.x; ++column)
            sum += cubic_sample((uv + offset(ivec2(column, row), count, width, across, down)) * size);
    for (int row = 0; row < linear.y; ++row)
        for (int column = 0; column < linear.x; ++column)
            sum += textureLod(picture, uv + offset(ivec2(column, row), count, width, across, down), level);
    return sum / float(count.x * count.y);
}

void main() {
    color = sharp_sample();
    color.rgb = mix(color.rgb, tint.rgb * color.a, tint.a);
    color *= opacity;
    if (inverted) color.rgb = color.a - color.rgb;
}
