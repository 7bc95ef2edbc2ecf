#include "tools/scenes/rooms.h"

MaterialDescription matte(const char* name, Vec3 albedo)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = albedo;
    material.lambert = true;
    material.double_sided = true;
    return material;
}

MaterialDescription glow(const char* name, Vec3 radiance)
{
    MaterialDescription material = matte(name, {0, 0, 0});
    material.emission = radiance;
    return material;
}

void addQuadAround(Mesh& mesh, Vec3 p, Vec3 u, Vec3 v, Opening opening)
{
    const auto part = [&](float u0, float u1, float v0, float v1)
    { addQuad(mesh, p + u * u0 + v * v0, u * (u1 - u0), v * (v1 - v0)); };
    part(0, opening.u0, 0, 1);
    part(opening.u1, 1, 0, 1);
    part(opening.u0, opening.u1, 0, opening.v0);
    part(opening.u0, opening.u1, opening.v1, 1);
}

Mesh innerFaces(Vec3 low, Vec3 high, bool right, bool top)
{
    const Vec3 size = high - low;
    const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    Mesh mesh;
    addQuad(mesh, low, z, x);    // floor
    addQuad(mesh, low, y, z);    // left
    addQuad(mesh, low, x, y);    // back
    addQuad(mesh, high, -y, -x); // front
    if (right)
        addQuad(mesh, high, -z, -y);
    if (top)
        addQuad(mesh, high, -x, -z);
    return mesh;
}
