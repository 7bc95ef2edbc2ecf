#include "compiler/tangents.h"

#include "compiler/linear.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;

/// Triangle soup with coordinates given, (0, 0, 1) as every normal.
MeshPrimitive flat(const std::vector<std::array<float, 4>>& vertices, const std::vector<gpu::uvec3>& triangles)
{
    MeshPrimitive mesh;
    for (const auto& [x, y, u, v] : vertices)
    {
        mesh.positions.push_back({x, y, 0});
        mesh.normals.push_back({0, 0, 1});
        mesh.uv0.push_back({u, v});
    }
    mesh.triangles = triangles;
    return mesh;
}

/// Of corner `corner` of triangle `t`.
gpu::vec4 tangentAt(const MeshPrimitive& mesh, size_t t, int corner)
{
    return mesh.tangents[(&mesh.triangles[t].x)[corner]];
}

void expectTangent(gpu::vec4 got, double angle, float sign, const std::string& what = "")
{
    EXPECT_NEAR(got.x, std::cos(angle), 1e-6) << what;
    EXPECT_NEAR(got.y, std::sin(angle), 1e-6) << what;
    EXPECT_NEAR(got.z, 0, 1e-6) << what;
    EXPECT_EQ(got.w, sign) << what;
}

TEST(Tangents, FollowUAndTellWhichWayVGoes)
{
    const std::vector<gpu::uvec3> one{{0, 1, 2}};
    for (const double turn : {0.0, 0.5, 2.5, 4.0}) // of the map on the triangle
    {
        const auto c = float(std::cos(turn)), s = float(std::sin(turn));
        MeshPrimitive down =
            flat({{0, 0, 0, 0}, {c, s, 1, 0}, {s, -c, 0, 1}}, {{0, 2, 1}}); // v down: as glTF pictures lie
        generateTangents(down, {});
        MeshPrimitive up = flat({{0, 0, 0, 0}, {c, s, 1, 0}, {-s, c, 0, 1}}, one);
        generateTangents(up, {});
        for (int corner = 0; corner < 3; ++corner)
        {
            expectTangent(tangentAt(down, 0, corner), turn, 1);
            expectTangent(tangentAt(up, 0, corner), turn, -1);
        }
    }
}

/// Two triangles about vertex 0, an eighth and a quarter of a turn wide there, whose maps are turned by 0 and by
/// `turn`.
MeshPrimitive corner(double turn)
{
    const auto h = float(std::sqrt(0.5));
    const auto c = float(std::cos(turn)), s = float(std::sin(turn));
    MeshPrimitive mesh = flat({{0, 0, 0, 0}, {h, h, 0, 0}, {1, 0, 0, 0}, {-h, h, 0, 0}}, {{0, 2, 1}, {0, 1, 3}});
    const auto turned = [&](size_t v, float cosine, float sine)
    {
        const gpu::vec3 p = mesh.positions[v];
        return gpu::vec2{cosine * p.x + sine * p.y, cosine * p.y - sine * p.x};
    };
    mesh.uv0[1] = turned(1, 1, 0); // shared by both: of the first map
    mesh.uv0[2] = turned(2, 1, 0);
    mesh.uv0[3] = turned(3, c, s);
    return mesh;
}

/// u's direction in a triangle with one corner at 0, by solving for the gradient's dual: e1 = du1 T + dv1 B.
double directionOf(const MeshPrimitive& mesh, gpu::uvec3 t)
{
    const auto edge = [&](uint32_t v) { return toDouble(mesh.positions[v]) - toDouble(mesh.positions[t.x]); };
    const auto du = [&](uint32_t v) { return double(mesh.uv0[v].x) - double(mesh.uv0[t.x].x); };
    const auto dv = [&](uint32_t v) { return double(mesh.uv0[v].y) - double(mesh.uv0[t.x].y); };
    const double determinant = du(t.y) * dv(t.z) - du(t.z) * dv(t.y);
    const Vec3d along = (edge(t.y) * dv(t.z) - edge(t.z) * dv(t.y)) * (1 / determinant);
    return std::atan2(along.y, along.x);
}

TEST(Tangents, SharedCornersHaveTheMeanByAngle)
{
    MeshPrimitive mesh = corner(0.6);
    const double first = directionOf(mesh, mesh.triangles[0]), second = directionOf(mesh, mesh.triangles[1]);
    ASSERT_GT(std::fabs(first - second), 0.1);
    generateTangents(mesh, {});
    // At vertex 0 the triangles are pi/4 and pi/2 wide; at vertex 1 3/8 pi and pi/4.
    const auto mean = [&](double w1, double w2)
    { return std::atan2(w1 * std::sin(first) + w2 * std::sin(second), w1 * std::cos(first) + w2 * std::cos(second)); };
    expectTangent(tangentAt(mesh, 0, 0), mean(kPi / 4, kPi / 2), -1, "vertex 0");
    expectTangent(tangentAt(mesh, 1, 0), mean(kPi / 4, kPi / 2), -1, "vertex 0");
    expectTangent(tangentAt(mesh, 0, 2), mean(kPi * 3 / 8, kPi / 4), -1, "vertex 1");
    expectTangent(tangentAt(mesh, 0, 1), first, -1, "vertex 2");
    expectTangent(tangentAt(mesh, 1, 2), second, -1, "vertex 3");
    EXPECT_EQ(mesh.positions.size(), 4u);
}

/// What is equal is one corner, however the file numbers it; what differs in normal or coordinates is two.
TEST(Tangents, VerticesAreWeldedByPositionNormalAndCoordinates)
{
    const MeshPrimitive shared = corner(0.6);
    MeshPrimitive apart = shared;
    apart.triangles[1] = {4, 5, 6};
    for (const size_t v : {0u, 1u, 3u})
    {
        apart.positions.push_back(gpu::vec3(shared.positions[v]));
        apart.normals.push_back(gpu::vec3(shared.normals[v]));
        apart.uv0.push_back(gpu::vec2(shared.uv0[v]));
    }
    MeshPrimitive welded = shared;
    generateTangents(welded, {});
    MeshPrimitive separate = apart;
    generateTangents(separate, {});
    for (size_t t = 0; t < 2; ++t)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(tangentAt(separate, t, c).y, tangentAt(welded, t, c).y) << t << " " << c;

    const double first = directionOf(shared, shared.triangles[0]), second = directionOf(shared, shared.triangles[1]);
    MeshPrimitive seam = apart; // the second triangle's coordinates lie elsewhere in the map
    for (const size_t v : {4u, 5u, 6u})
        seam.uv0[v].x += 1;
    MeshPrimitive crease = apart; // the second triangle's normals are a little different
    for (const size_t v : {4u, 5u, 6u})
        crease.normals[v] = normalizeOr({0, 0.01f, 1}, {});
    for (MeshPrimitive* mesh : {&seam, &crease})
    {
        generateTangents(*mesh, {});
        expectTangent(tangentAt(*mesh, 0, 0), first, -1);
        EXPECT_NEAR(std::atan2(tangentAt(*mesh, 1, 0).y, tangentAt(*mesh, 1, 0).x), second, 1e-4);
    }
}

TEST(Tangents, TrianglesThatMeetInAPointOnlyDoNotShare)
{
    MeshPrimitive mesh = corner(0.6);
    mesh.triangles = {{0, 2, 1}, {0, 3, 4}}; // the second turned away from the first's edges
    mesh.positions.push_back({-1, -1, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.uv0.push_back({-2, 0.5f});
    const double first = directionOf(mesh, mesh.triangles[0]), second = directionOf(mesh, mesh.triangles[1]);
    const float first_sign = handedness(mesh, mesh.triangles[0], {}),
                second_sign = handedness(mesh, mesh.triangles[1], {});
    generateTangents(mesh, {});
    expectTangent(tangentAt(mesh, 0, 0), first, first_sign);
    expectTangent(tangentAt(mesh, 1, 0), second, second_sign);
    EXPECT_EQ(mesh.positions.size(), 6u); // vertex 0 is split
}

TEST(Tangents, MirroredMapsSplitTheVerticesOnTheirSeam)
{
    // A map mirrored about x = 0: vertices 0 and 1 lie on the seam.
    MeshPrimitive mesh = flat({{0, 0, 0, 0}, {0, 1, 0, 1}, {1, 0, 1, 0}, {-1, 0, 1, 0}}, {{0, 2, 1}, {0, 1, 3}});
    generateTangents(mesh, {});
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.normals.size(), 6u);
    EXPECT_EQ(mesh.uv0.size(), 6u);
    for (int c = 0; c < 3; ++c)
    {
        expectTangent(tangentAt(mesh, 0, c), 0, -1);
        expectTangent(tangentAt(mesh, 1, c), kPi, 1);
    }
    for (const gpu::uvec3 t : mesh.triangles)
        for (const uint32_t v : {t.x, t.y, t.z})
            EXPECT_LT(v, mesh.positions.size());
}

TEST(Tangents, AreOrthogonalToTheNormalsThatTheyAreFor)
{
    MeshPrimitive mesh = flat({{0, 0, 0, 0}, {1, 0, 1, 0}, {0, 1, 0, 1}}, {{0, 1, 2}});
    mesh.normals = {normalizeOr({-1, 0, 1}, {}), normalizeOr({1, 0, 1}, {}), normalizeOr({0, 1, 1}, {})};
    generateTangents(mesh, {});
    const float h = std::sqrt(0.5f);
    const std::array<gpu::vec3, 3> want{gpu::vec3{h, 0, h}, gpu::vec3{h, 0, -h}, gpu::vec3{1, 0, 0}};
    for (int c = 0; c < 3; ++c)
    {
        const gpu::vec4 t = tangentAt(mesh, 0, c);
        EXPECT_NEAR(length(gpu::vec3{t.x, t.y, t.z} - want[size_t(c)]), 0, 1e-6) << c;
    }
}

TEST(Tangents, TrianglesWithoutCoordinatesTakeTheirNeighboursAndCountNothing)
{
    MeshPrimitive alone = flat({{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}}, {{0, 1, 2}});
    generateTangents(alone, {});
    for (const gpu::vec4& t : alone.tangents)
        EXPECT_NEAR(t.x * t.x + t.y * t.y, 1, 1e-6);

    // The second triangle's corners lie on one line of the map.
    MeshPrimitive joined = flat({{0, 0, 0, 0}, {0, 1, 0, 1}, {1, 0, 1, 0}, {-1, 0, 0, 2}}, {{0, 2, 1}, {0, 1, 3}});
    generateTangents(joined, {});
    EXPECT_EQ(joined.positions.size(), 4u);
    expectTangent(tangentAt(joined, 0, 0), 0, -1);
    expectTangent(tangentAt(joined, 1, 0), 0, -1);
    expectTangent(tangentAt(joined, 1, 1), 0, -1);
}

TEST(Tangents, ASpheresFollowItsParallels)
{
    // u along the parallels, v along the meridians from the north; a seam of double vertices.
    constexpr int kU = 24, kV = 12;
    MeshPrimitive mesh;
    for (int j = 0; j <= kV; ++j)
        for (int i = 0; i <= kU; ++i)
        {
            const double phi = 2 * kPi * (i % kU) / kU, theta = kPi * j / kV;
            const gpu::vec3 p{float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                              float(std::cos(theta))};
            mesh.positions.push_back(gpu::vec3(p));
            mesh.normals.push_back(gpu::vec3(p));
            mesh.uv0.push_back({float(i) / kU, float(j) / kV});
        }
    for (uint32_t j = 1; j + 1 < kV; ++j) // without the poles
        for (uint32_t i = 0; i < kU; ++i)
        {
            const uint32_t v = j * (kU + 1) + i;
            mesh.triangles.push_back({v, v + kU + 1, v + 1});
            mesh.triangles.push_back({v + 1, v + kU + 1, v + kU + 2});
        }
    const size_t vertex_count = mesh.positions.size();
    EXPECT_EQ(generateTangents(mesh, {}), vertex_count);
    // In every triangle u runs along its edge on a parallel, half a cell before or behind the vertex.
    for (const gpu::uvec3 t : mesh.triangles)
        for (const uint32_t v : {t.x, t.y, t.z})
        {
            const double phi = std::atan2(mesh.positions[v].y, mesh.positions[v].x);
            const gpu::vec4 got = mesh.tangents[v];
            EXPECT_GT(-std::sin(phi) * got.x + std::cos(phi) * got.y, std::cos(kPi / kU) - 1e-5) << v;
            EXPECT_EQ(got.w, 1);
        }
}
} // namespace
