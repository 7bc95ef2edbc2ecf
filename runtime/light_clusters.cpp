#include "runtime/light_clusters.h"

#include "shaders/direct/survey.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <unordered_map>

namespace
{
using Point = std::array<float, 3>;

Point toPoint(gpu::vec3 v)
{
    return {v.x, v.y, v.z};
}

struct Bits
{
    size_t operator()(const Point& p) const
    {
        uint64_t hash = 0;
        for (const float x : p)
            hash = (hash ^ std::bit_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15;
        return size_t(hash ^ hash >> 32);
    }
};

bool isLocal(const gpu::Light& light)
{
    return light.kind != gpu::kLightDirectional && light.kind != gpu::kLightEnvironment;
}

bool isTriangle(const gpu::Light& light)
{
    return light.kind == gpu::kLightTriangle || light.kind == gpu::kLightTriangleTwoSided;
}

/// Sets that grow together.
class Unions
{
public:
    explicit Unions(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
    uint32_t find(uint32_t i)
    {
        while (parents_[i] != i)
            i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) { parents_[find(b)] = find(a); }

private:
    std::vector<uint32_t> parents_;
};

struct Object
{
    uint32_t id;  // the light that stands for it
    double power; // of all lights' pmf
    Point center;
};

/// Objects of local lights. @param ids set to the object of each light
std::vector<Object> objectsOf(std::span<const gpu::Light> lights, std::vector<uint32_t>& ids)
{
    Unions unions(lights.size());
    std::unordered_map<Point, uint32_t, Bits> corners;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (isTriangle(lights[i]))
            for (const gpu::vec3 corner : {lights[i].p0, lights[i].p1, lights[i].p2})
                if (const auto [entry, added] = corners.try_emplace(toPoint(corner), i); !added)
                    unions.join(entry->second, i);
    std::vector<Object> objects;
    std::unordered_map<uint32_t, size_t> places;
    for (uint32_t i = 0; i < lights.size(); ++i)
    {
        if (!isLocal(lights[i]))
            continue;
        ids[i] = unions.find(i);
        const auto [entry, added] = places.try_emplace(ids[i], objects.size());
        if (added)
            objects.push_back({.id = ids[i], .power = 0, .center = toPoint(lights[i].p0)});
        objects[entry->second].power += double(lights[i].pmf);
    }
    return objects;
}

/// Objects next to each other in a list.
struct Part
{
    std::span<Object> objects;
    size_t axis = 0;
    double need = 0; // to be divided: its power times its width squared
};

Part partOf(std::span<Object> objects)
{
    Part part{.objects = objects};
    double power = 0, width = 0;
    for (const Object& object : objects)
        power += object.power;
    for (size_t axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] =
            std::ranges::minmax(objects, {}, [axis](const Object& object) { return object.center[axis]; });
        const double extent = double(high.center[axis]) - double(low.center[axis]);
        if (extent > width)
        {
            width = extent;
            part.axis = axis;
        }
    }
    part.need = power * width * width;
    return part;
}

/// Two halves of about the same power.
std::pair<Part, Part> divide(Part part)
{
    std::ranges::sort(part.objects, {}, [&](const Object& object) { return object.center[part.axis]; });
    double power = 0, all = 0;
    for (const Object& object : part.objects)
        all += object.power;
    size_t half = 0;
    while (half + 1 < part.objects.size() && (half == 0 || power + part.objects[half].power <= all / 2))
        power += part.objects[half++].power;
    return {partOf(part.objects.first(half)), partOf(part.objects.subspan(half))};
}
} // namespace

std::vector<uint32_t> clusterLights(std::span<const gpu::Light> lights)
{
    std::vector<uint32_t> ids(lights.size());
    std::vector<Object> objects = objectsOf(lights, ids);
    std::vector<uint32_t> clusters(lights.size());
    if (objects.empty())
        return clusters;
    std::vector<Part> parts{partOf(objects)};
    while (parts.size() < gpu::kMostClusters)
    {
        const auto widest = std::ranges::max_element(parts, {}, &Part::need);
        if (widest->need <= 0)
            break;
        const auto [low, high] = divide(*widest);
        *widest = low;
        parts.push_back(high);
    }
    std::unordered_map<uint32_t, uint32_t> cluster_of;
    for (uint32_t i = 0; i < parts.size(); ++i)
        for (const Object& object : parts[i].objects)
            cluster_of[object.id] = i;
    for (size_t i = 0; i < lights.size(); ++i)
        if (isLocal(lights[i]))
            clusters[i] = cluster_of.at(ids[i]);
    return clusters;
}
