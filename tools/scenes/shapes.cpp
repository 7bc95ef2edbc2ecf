#include "tools/scenes/shapes.h"

#include <algorithm>
#include <numbers>

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;

float distance(Vec2 a, Vec2 b)
{
    return std::hypot(b.x - a.x, b.y - a.y);
}

Vec2 segmentNormal(Vec2 a, Vec2 b) // to the right of the way from a to b
{
    const float l = distance(a, b);
    return {(b.y - a.y) / l, (a.x - b.x) / l};
}

/// Normals at both ends of every segment of a profile; neighbours closer than 35 degrees share their mean.
std::vector<std::pair<Vec2, Vec2>> profileNormals(const std::vector<Vec2>& profile, bool closed, bool always_smooth)
{
    const size_t count = profile.size() - (closed ? 0 : 1);
    std::vector<Vec2> flat;
    for (size_t i = 0; i < count; ++i)
        flat.push_back(segmentNormal(profile[i], profile[(i + 1) % profile.size()]));
    const auto blend = [&](size_t self, size_t other)
    {
        const Vec2 a = flat[self], b = flat[other];
        if (!always_smooth && a.x * b.x + a.y * b.y < 0.82f)
            return a;
        const float l = std::hypot(a.x + b.x, a.y + b.y);
        return Vec2{(a.x + b.x) / l, (a.y + b.y) / l};
    };
    std::vector<std::pair<Vec2, Vec2>> normals;
    for (size_t i = 0; i < count; ++i)
    {
        const bool first = i == 0 && !closed, last = i + 1 == count && !closed;
        normals.emplace_back(first ? flat[i] : blend(i, (i + count - 1) % count),
                             last ? flat[i] : blend(i, (i + 1) % count));
    }
    return normals;
}

/// Revolves one segment of a profile about +Y.
void revolve(Mesh& mesh, Vec2 p0, Vec2 p1, std::pair<Vec2, Vec2> normals, float v0, float texture_round,
             uint32_t segments)
{
    const uint32_t base = uint32_t(mesh.positions.size());
    for (uint32_t i = 0; i <= segments; ++i)
    {
        const float t = float(i) / float(segments);
        const float c = std::cos(2 * kPi * t), s = i == segments ? 0.0f : std::sin(2 * kPi * t);
        const auto vertex = [&](Vec2 p, Vec2 n, float v) {
            mesh.addVertex({p.x * c, p.y, p.x * s}, {n.x * c, n.y, n.x * s}, {-t * texture_round, -v});
        };
        vertex(p0, normals.first, v0);
        vertex(p1, normals.second, v0 + distance(p0, p1));
    }
    for (uint32_t i = 0; i < segments; ++i)
    {
        const uint32_t a = base + 2 * i, d = a + 1, b = a + 2, c = a + 3;
        if (p1.x > 0)
            mesh.addTriangle(a, d, c);
        if (p0.x > 0)
            mesh.addTriangle(a, c, b);
    }
}

Mesh revolved(const std::vector<Vec2>& profile, uint32_t segments, bool closed, bool always_smooth)
{
    Mesh mesh;
    float widest = 0;
    for (Vec2 p : profile)
        widest = std::max(widest, p.x);
    const auto normals = profileNormals(profile, closed, always_smooth);
    float v = 0;
    for (size_t i = 0; i < normals.size(); ++i)
    {
        const Vec2 p0 = profile[i], p1 = profile[(i + 1) % profile.size()];
        revolve(mesh, p0, p1, normals[i], v, 2 * kPi * widest, segments);
        v += distance(p0, p1);
    }
    return mesh;
}

} // namespace

uint32_t Mesh::addVertex(Vec3 position, Vec3 normal, Vec2 uv)
{
    positions.push_back(position);
    normals.push_back(normalize(normal));
    uvs.push_back(uv);
    return uint32_t(positions.size() - 1);
}

void Mesh::addTriangle(uint32_t a, uint32_t b, uint32_t c)
{
    indices.insert(indices.end(), {a, b, c});
}

void Mesh::add(const Mesh& part, const Placement& placement)
{
    const uint32_t base = uint32_t(positions.size());
    for (size_t i = 0; i < part.positions.size(); ++i)
        addVertex(placement.point(part.positions[i]), placement.direction(part.normals[i]), part.uvs[i]);
    for (uint32_t index : part.indices)
        indices.push_back(base + index);
}

void Mesh::scaleUvs(float per_metre)
{
    for (Vec2& uv : uvs)
        uv = {uv.x * per_metre, uv.y * per_metre};
}

void addQuad(Mesh& mesh, Vec3 p, Vec3 u, Vec3 v)
{
    const Vec3 n = cross(u, v);
    const float w = length(u), h = length(v);
    const uint32_t a = mesh.addVertex(p, n, {0, h});
    const uint32_t b = mesh.addVertex(p + u, n, {w, h});
    const uint32_t c = mesh.addVertex(p + u + v, n, {w, 0});
    const uint32_t d = mesh.addVertex(p + v, n, {0, 0});
    mesh.addTriangle(a, b, c);
    mesh.addTriangle(a, c, d);
}

Mesh sheet(uint32_t columns, uint32_t rows, Vec2 size, const std::function<Vec3(float, float)>& point)
{
    Mesh mesh;
    constexpr float kStep = 1e-3f;
    for (uint32_t j = 0; j <= rows; ++j)
    {
        for (uint32_t i = 0; i <= columns; ++i)
        {
            const float s = float(i) / float(columns), t = float(j) / float(rows);
            const Vec3 ds = point(s + kStep, t) - point(s - kStep, t);
            const Vec3 dt = point(s, t + kStep) - point(s, t - kStep);
            mesh.addVertex(point(s, t), cross(ds, dt), {s * size.x, (1 - t) * size.y});
        }
    }
    for (uint32_t j = 0; j < rows; ++j)
    {
        for (uint32_t i = 0; i < columns; ++i)
        {
            const uint32_t a = j * (columns + 1) + i, d = a + columns + 1;
            mesh.addTriangle(a, a + 1, d + 1);
            mesh.addTriangle(a, d + 1, d);
        }
    }
    return mesh;
}

Mesh box(Vec3 low, Vec3 high, float bevel)
{
    Mesh mesh;
    const Vec3 center = (low + high) * 0.5f, half = (high - low) * 0.5f;
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const float extent[3] = {half.x, half.y, half.z};
    const auto corner = [&](int axis, float a, float b, float c) // along axis, next, the one after
    { return center + axes[axis] * a + axes[(axis + 1) % 3] * b + axes[(axis + 2) % 3] * c; };

    for (int axis = 0; axis < 3; ++axis)
    {
        const float h = extent[axis], n = extent[(axis + 1) % 3], m = extent[(axis + 2) % 3];
        // Sides: keep texture v vertical on upright faces by choosing which edge comes first.
        for (float sign : {-1.0f, 1.0f})
        {
            const float b = n - bevel, c = m - bevel;
            const bool swap = axis == 0; // +x: next is y, then z
            const Vec3 e1 = axes[(axis + 1) % 3] * (2 * b), e2 = axes[(axis + 2) % 3] * (2 * c);
            if (!swap)
            {
                if (sign > 0)
                    addQuad(mesh, corner(axis, h, -b, -c), e1, e2);
                else
                    addQuad(mesh, corner(axis, -h, b, -c), -e1, e2);
            }
            else
            {
                if (sign > 0)
                    addQuad(mesh, corner(axis, h, -b, c), -e2, e1);
                else
                    addQuad(mesh, corner(axis, -h, -b, -c), e2, e1);
            }
        }
        if (bevel <= 0)
            continue;
        // The four chamfers that run along this axis, and (once) the eight corner triangles.
        const float along = h - bevel;
        for (float sb : {-1.0f, 1.0f})
        {
            for (float sc : {-1.0f, 1.0f})
            {
                const Vec3 p = corner(axis, -along, sb * n, sc * (m - bevel));
                const Vec3 q = corner(axis, -along, sb * (n - bevel), sc * m);
                const Vec3 u = axes[axis] * (2 * along);
                if (sb * sc > 0)
                    addQuad(mesh, p, q - p, u);
                else
                    addQuad(mesh, q, p - q, u);
                if (axis == 0)
                {
                    for (float sa : {-1.0f, 1.0f})
                    {
                        const Vec3 normal{sa, sb, sc};
                        const Vec3 x = corner(0, sa * h, sb * (n - bevel), sc * (m - bevel));
                        const Vec3 y = corner(0, sa * (h - bevel), sb * n, sc * (m - bevel));
                        const Vec3 z = corner(0, sa * (h - bevel), sb * (n - bevel), sc * m);
                        const uint32_t i = mesh.addVertex(x, normal, {0, 0});
                        const uint32_t j = mesh.addVertex(y, normal, {bevel, 0});
                        const uint32_t k = mesh.addVertex(z, normal, {0, bevel});
                        if (sa * sb * sc > 0)
                            mesh.addTriangle(i, j, k);
                        else
                            mesh.addTriangle(i, k, j);
                    }
                }
            }
        }
    }
    return mesh;
}

Mesh lathe(const std::vector<Vec2>& profile, uint32_t segments)
{
    return revolved(profile, segments, false, false);
}

Mesh ring(const std::vector<Vec2>& profile, uint32_t segments)
{
    return revolved(profile, segments, true, true);
}

Mesh sphere(float radius, uint32_t segments, uint32_t rings)
{
    std::vector<Vec2> profile;
    for (uint32_t i = 0; i <= rings; ++i)
    {
        const float latitude = kPi * (float(i) / float(rings) - 0.5f);
        const bool pole = i == 0 || i == rings;
        profile.push_back({pole ? 0.0f : radius * std::cos(latitude), radius * std::sin(latitude)});
    }
    Mesh mesh = revolved(profile, segments, false, true);
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.normals[i] = normalize(mesh.positions[i]);
    return mesh;
}

Mesh flutedShaft(float radius, float height, uint32_t flutes)
{
    const uint32_t around = flutes * 4;
    const auto point = [&](float s, float t)
    {
        const float angle = -2 * kPi * s; // clockwise from above, so that the sheet faces outwards
        const float hollow = std::abs(std::sin(0.5f * float(flutes) * angle));
        const float r = radius * (1 - 0.125f * t * t) * (1 - 0.07f * hollow);
        return Vec3{r * std::cos(angle), height * t, r * std::sin(angle)};
    };
    return sheet(around, 5, {2 * kPi * radius, height}, point);
}

Mesh archBay(float width, float height, float radius, float depth, float foot, bool back, uint32_t segments)
{
    Mesh mesh;
    const float half = 0.5f * width;
    std::vector<float> angles;
    for (uint32_t i = 0; i <= segments; ++i)
        angles.push_back(kPi * float(i) / float(segments));
    const float corner = std::atan2(height, half);
    angles.insert(angles.end(), {corner, kPi - corner});
    std::sort(angles.begin(), angles.end());

    const auto inner = [&](float a) {
        return Vec2{radius * std::cos(a), a == 0 || a == angles.back() ? 0.0f : radius * std::sin(a)};
    };
    const auto outer = [&](float a) // where the ray at angle `a` leaves the wall
    {
        const float c = std::cos(a), s = std::sin(a);
        if (std::abs(c) * height >= s * half)
            return Vec2{c > 0 ? half : -half, a == angles.back() ? 0.0f : half * s / std::abs(c)};
        return Vec2{height * c / s, height};
    };
    const auto face = [&](Vec2 a, Vec2 b, Vec2 c, Vec2 d, float z, float facing)
    {
        const auto vertex = [&](Vec2 p) { return mesh.addVertex({p.x, p.y, z}, {0, 0, facing}, {p.x * facing, -p.y}); };
        const uint32_t i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
        if (facing > 0)
        {
            mesh.addTriangle(i, j, k);
            mesh.addTriangle(i, k, l);
        }
        else
        {
            mesh.addTriangle(i, k, j);
            mesh.addTriangle(i, l, k);
        }
    };
    const auto bothFaces = [&](Vec2 a, Vec2 b, Vec2 c, Vec2 d)
    {
        face(a, b, c, d, 0, 1);
        if (back)
            face(a, b, c, d, -depth, -1);
    };
    for (size_t i = 0; i + 1 < angles.size(); ++i)
    {
        const float a = angles[i], b = angles[i + 1];
        if (b - a < 1e-5f)
            continue;
        bothFaces(inner(a), outer(a), outer(b), inner(b));
        // Intrados: normals towards the axis.
        const auto vertex = [&](float angle, float z)
        {
            const Vec2 p = inner(angle);
            return mesh.addVertex({p.x, p.y, z}, {-std::cos(angle), -std::sin(angle), 0}, {-z, -radius * angle});
        };
        const uint32_t p = vertex(a, 0), q = vertex(b, 0), r = vertex(b, -depth), s = vertex(a, -depth);
        mesh.addTriangle(p, q, r);
        mesh.addTriangle(p, r, s);
    }
    for (float side : {-1.0f, 1.0f}) // the feet
    {
        const float x0 = side > 0 ? radius : -half, x1 = side > 0 ? half : -radius;
        bothFaces({x0, -foot}, {x1, -foot}, {x1, 0}, {x0, 0});
        if (side > 0)
            addQuad(mesh, {radius, -foot, -depth}, {0, 0, depth}, {0, foot, 0});
        else
            addQuad(mesh, {-radius, -foot, 0}, {0, 0, -depth}, {0, foot, 0});
    }
    return mesh;
}

Mesh archMoulding(const std::vector<Vec2>& profile, uint32_t segments)
{
    Mesh mesh;
    const auto normals = profileNormals(profile, false, false);
    for (size_t k = 0; k < normals.size(); ++k)
    {
        const uint32_t base = uint32_t(mesh.positions.size());
        for (uint32_t i = 0; i <= segments; ++i)
        {
            const float a = kPi * float(i) / float(segments);
            const float c = std::cos(a), s = i == segments ? 0.0f : std::sin(a);
            const auto vertex = [&](Vec2 p, Vec2 n) // segmentNormal points right of the way: turn it to face outwards
            {
                mesh.addVertex({p.x * c, p.x * s, p.y}, {-n.x * c, -n.x * s, -n.y}, {p.x * a, p.y});
            };
            vertex(profile[k], normals[k].first);
            vertex(profile[k + 1], normals[k].second);
        }
        for (uint32_t i = 0; i < segments; ++i)
        {
            const uint32_t a = base + 2 * i;
            mesh.addTriangle(a, a + 1, a + 3);
            mesh.addTriangle(a, a + 3, a + 2);
        }
    }
    return mesh;
}
