#include "runtime/stages/views.h"

#include <algorithm>
#include <cmath>

namespace
{
gpu::ViewParams viewParams(const ViewsStage::Input& in)
{
    return {.view = in.view,
            .width = in.camera.width,
            .height = in.camera.height,
            .curve = in.tonemap,
            .exposure = std::exp2(in.exposure)};
}

uint32_t pixelCount(const ViewsStage::Input& in)
{
    return in.camera.width * in.camera.height;
}
} // namespace

ViewsStage::ViewsStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels)
    : device_(device), scene_(scene), marks_(device.array<uint32_t>("views.marks", max_pixels))
{
}

void ViewsStage::recordPoints(Recorder& rec, const Input& in) const
{
    rec.run(surfaceKernel("views/points"), pixelCount(in), viewParams(in),
            {{"Points", in.points}, {"Radiance", in.radiance}});
}

void ViewsStage::recordNonFinite(Recorder& rec, const Input& in) const
{
    rec.run(kernel("views/non_finite"), pixelCount(in), viewParams(in), {{"Radiance", in.radiance}});
}

void ViewsStage::markSamples(Recorder& rec, const gpu::ViewParams& params, const SamplesStage::Output& samples) const
{
    rec.clear(marks_);
    rec.runIndirect(kernel("views/mark_samples"), samples.size, params,
                    {{"Size", samples.size}, {"Samples", samples.samples}, {"Marks", marks_}});
}

void ViewsStage::recordSamples(Recorder& rec, const Input& in, const SamplesStage::Output& samples) const
{
    markSamples(rec, viewParams(in), samples);
    rec.run(kernel("views/samples"), pixelCount(in), viewParams(in), {{"Marks", marks_}, {"Radiance", in.radiance}});
}

void ViewsStage::recordQuadtree(Recorder& rec, const Input& in, const SamplesStage::Output& samples,
                                const SamplesStage::Quadtree& quadtree) const
{
    constexpr double kShownBudget = 4; // samples of a node at least, were they spread evenly: fewer would show rounding
    const double per_point = double(in.budget) * quadtree.stride * quadtree.stride / pixelCount(in);
    uint32_t level = 1;
    while (level < quadtree.levels && per_point * std::exp2(2 * level) < kShownBudget)
        ++level;
    const gpu::QuadViewParams params{.view = viewParams(in),
                                     .stride = quadtree.stride,
                                     .levels = quadtree.levels,
                                     .level = level,
                                     .mean = float(per_point * std::exp2(2 * level))};
    if (in.view == gpu::kViewBudget)
    {
        rec.run(kernel("views/budget"), pixelCount(in), params,
                {{"Budgets", quadtree.budgets}, {"Radiance", in.radiance}});
        return;
    }
    markSamples(rec, params.view, samples);
    rec.run(kernel("views/clusters"), pixelCount(in), params,
            {{"Marks", marks_}, {"Owners", quadtree.owners}, {"Radiance", in.radiance}});
}

void ViewsStage::recordPhotons(Recorder& rec, const Input& in, const PhotonTreeStage::Output& map) const
{
    rec.clear(marks_);
    const gpu::PhotonViewParams marking{.camera = in.camera,
                                        .most = std::max(pixelCount(in) / gpu::kViewPhotonShare, 1u)};
    rec.runIndirect(kernel("views/mark_photons"), map.size, marking,
                    {{"Size", map.size}, {"Photons", map.photons}, {"Points", in.points}, {"Marks", marks_}});
    rec.run(kernel("views/photons"), pixelCount(in), viewParams(in),
            {{"Marks", marks_}, {"Photons", map.photons}, {"Radiance", in.radiance}});
}

void ViewsStage::recordTree(Recorder& rec, const Input& in, const PhotonTreeStage::Output& map) const
{
    rec.run(kernel("views/tree"), pixelCount(in), viewParams(in),
            {{"Size", map.size}, {"TreeNodes", map.tree.nodes()}, {"Points", in.points}, {"Radiance", in.radiance}});
}

void ViewsStage::recordCut(Recorder& rec, const Input& in, const CutStage::Output& cut) const
{
    rec.run(surfaceKernel("views/cut"), pixelCount(in), viewParams(in),
            {{"CutSize", cut.size},
             {"TreeNodes", cut.tree.nodes()},
             {"CutNodes", cut.nodes},
             {"Points", in.points},
             {"Radiance", in.radiance}});
}
