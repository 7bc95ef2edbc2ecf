// Constants, frames and encodings. Functions only.
#ifndef LIB_MATH_GLSL
#define LIB_MATH_GLSL

const float kPi = 3.14159265358979;
const float kInvPi = 0.318309886183791;
const float kInfinity = 3e38; // metres: farther than everything, and still finite when scaled by an ulp

float square(float x) { return x * x; }
vec3 square(vec3 v) { return v * v; }
float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }
/// a / b, where that is below 2^20, without an integer division: software Vulkan makes those one thread after the other.
uint quotient(uint a, uint b)
{
    uint q = uint(float(a) / float(b)); // one too large or too small at most
    int rest = int(a - q * b);
    return rest < 0 ? q - 1u : rest >= int(b) ? q + 1u : q;
}
/// Rec. 709 luminance of linear RGB.
float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

/// |d|^2 with d's part along the normal n counting four times: what lies off a surface's plane is probably on another one,
/// whose light must not leak (Jensen 2001 compresses the sphere of a density estimate likewise).
float surfaceDistance2(vec3 d, vec3 n) { return dot(d, d) + 15.0 * square(dot(d, n)); }

/// A right-handed orthonormal frame with z = n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
mat3 frameAround(vec3 n)
{
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

/// Octahedral encoding, e in [-1,1]^2, to a unit vector (Cigolle et al. 2014).
vec3 octahedralToUnit(vec2 e)
{
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-v.z, 0.0);
    v.x += v.x >= 0.0 ? -t : t;
    v.y += v.y >= 0.0 ? -t : t;
    return normalize(v);
}

vec2 unitToOctahedral(vec3 v)
{
    vec2 e = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    return v.z >= 0.0 ? e : (1.0 - abs(e.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(e, vec2(0.0)));
}

uint packNormal(vec3 n) { return packSnorm2x16(unitToOctahedral(n)); }
vec3 unpackNormal(uint bits) { return octahedralToUnit(unpackSnorm2x16(bits)); }

/// A direction about z, by its cosine.
vec3 cosineDirection(vec2 u)
{
    float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
    return vec3(r * cos(phi), r * sin(phi), sqrt(max(0.0, 1.0 - u.x)));
}

// ---- Rounding. Everything here is proportional to coordinates, so that it holds at every scale and place.

const float kRounding = 8.0 / 16777216.0; // relative: some single roundings on top of each other

vec3 largestMagnitude(vec3 a, vec3 b, vec3 c) { return max(abs(a), max(abs(b), abs(c))); }

/// How far rounding may put a point worked out on a triangle off the triangle's plane, and how far off it a ray may meet that.
/// First order: a normal's component has the error of the products it is the difference of. 0 for a plane along the axes
/// through the origin. Slivers, whose planes are next to undefined, are off by 64 of their largest coordinate's errors at most.
/// @param reach largest magnitudes, by axis, of the coordinates that the point was worked out from besides the corners'
/// @return metres
float planeError(vec3 a, vec3 b, vec3 c, vec3 reach)
{
    vec3 u = abs(b - a), v = abs(c - a);
    vec3 products = u.yzx * v.zxy + u.zxy * v.yzx;
    vec3 largest = largestMagnitude(a, b, c) + reach;
    return kRounding * min(dot(products, largest) / length(cross(b - a, c - a)), 64.0 * maxComponent(largest));
}

/// Origin for a ray that leaves a surface of which only a point and the normal are known.
vec3 offsetOrigin(vec3 p, vec3 n) { return p + 4.0 * kRounding * maxComponent(abs(p)) * n; }

#endif
