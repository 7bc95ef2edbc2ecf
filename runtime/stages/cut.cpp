#include "runtime/stages/cut.h"

CutStage::CutStage(const Device& device, const SceneGpu& scene, uint32_t max_photons, const Scratch& scratch)
    : reduce_upward_(device.kernel("cut/reduce_upward", {climbConstant(device)})),
      coarse_(device.kernel("cut/coarse", scene.constants(), {climbConstant(device)})),
      select_(device.kernel("cut/select")), refine_(device.kernel("cut/refine")),
      reorder_(device.kernel("cut/reorder")), build_leaves_(device.kernel("cut/build_leaves")),
      probe_(device.kernel("cut/probe", scene.constants())), keys_(device.kernel("cut/keys")),
      sample_direction_(device.kernel("cut/sample_direction", scene.constants())),
      compaction_(device, "cut.compaction", 2 * max_photons), tree_(device, "cut.tree", max_photons, scratch),
      sums_(device.array<gpu::PhotonSums>("cut.sums", max_photons, scratch)),
      arrivals_(device.array<uint32_t>("cut.arrivals", max_photons, scratch)),
      id_count_(device.array<gpu::QueueSize>("cut.id_count", 1)),
      divided_(device.array<uint32_t>("cut.divided", max_photons, scratch)),
      work_(device.array<uint32_t>("cut.work", max_photons, scratch)),
      next_work_(device.array<uint32_t>("cut.next_work", max_photons, scratch)),
      work_size_(device.array<gpu::QueueSize>("cut.work_size", 1)),
      next_work_size_(device.array<gpu::QueueSize>("cut.next_work_size", 1)),
      members_(device.array<uint32_t>("cut.members", 2 * uint64_t(max_photons), scratch)),
      finals_(device.array<gpu::CutNode>("cut.finals", 2 * uint64_t(max_photons), scratch)),
      size_(device.array<gpu::QueueSize>("cut.size", 1)), ids_(device.array<uint32_t>("cut.ids", max_photons, scratch)),
      spheres_(device.array<gpu::vec4>("cut.spheres", max_photons, scratch)),
      nodes_(device.texelArray<gpu::CutNode>("cut.nodes", max_photons)),
      unsorted_directions_(device.array<uint32_t>("cut.unsorted_directions", max_photons, scratch)),
      directions_(device.array<uint32_t>("cut.directions", max_photons)),
      probe_size_(device.array<gpu::QueueSize>("cut.probe_size", 1))
{
}

CutStage::Output CutStage::record(Recorder& rec, const RayStage& rays, const PhotonTreeStage::Output& map,
                                  const Input& in) const
{
    const Buffer& tree_nodes = map.tree.nodes();
    const Buffer& leaf_parents = map.tree.leafParents();
    const Buffer& node_parents = map.tree.nodeParents();
    gpu::CutParams params{.mode = uint32_t(in.mode),
                          .last = 0,
                          .difference = in.difference,
                          .photon_count = in.photon_count,
                          .radius = in.radius,
                          .spread = gpu::kCutSpread * in.shrink,
                          .fewest = in.fewest,
                          .most_nodes = gpu::kCutProbeCapacity / std::max(in.probes + in.rim_probes, 1u)};
    rec.clear(arrivals_);
    rec.runIndirect(reduce_upward_, map.size, NoParams{},
                    {{"Size", map.size},
                     {"TreeNodes", tree_nodes},
                     {"Photons", map.photons},
                     {"LeafParents", leaf_parents},
                     {"NodeParents", node_parents},
                     {"Sums", sums_},
                     {"Arrivals", arrivals_}});
    rec.clear(arrivals_);
    rec.clear(divided_);
    rec.clear(id_count_); // a tree without photons starts no thread
    rec.runIndirect(coarse_, map.size, params,
                    {{"Size", map.size},
                     {"TreeNodes", tree_nodes},
                     {"Photons", map.photons},
                     {"LeafParents", leaf_parents},
                     {"NodeParents", node_parents},
                     {"Sums", sums_},
                     {"Divided", divided_},
                     {"Arrivals", arrivals_},
                     {"Ids", id_count_}});

    const Buffer* work = &work_;
    const Buffer* work_size = &work_size_;
    const Buffer* next = &next_work_;
    const Buffer* next_size = &next_work_size_;
    rec.clear(*work_size);
    rec.runIndirect(select_, id_count_, NoParams{},
                    {{"Size", map.size},
                     {"Ids", id_count_},
                     {"LeafParents", leaf_parents},
                     {"NodeParents", node_parents},
                     {"Divided", divided_},
                     {"WorkSize", *work_size},
                     {"Work", *work}});
    rays.close(rec, *work_size);
    rec.clear(members_);
    if (in.mode == CutMode::kLeaves)
        rec.runIndirect(build_leaves_, *work_size, params,
                        {{"Size", map.size},
                         {"TreeNodes", tree_nodes},
                         {"Photons", map.photons},
                         {"LeafParents", leaf_parents},
                         {"NodeParents", node_parents},
                         {"Sums", sums_},
                         {"WorkSize", *work_size},
                         {"Work", *work},
                         {"Members", members_},
                         {"Finals", finals_}});
    for (uint32_t round = 0; in.mode != CutMode::kLeaves && round <= in.iterations; ++round)
    {
        params.last = round == in.iterations;
        rec.clear(*next_size);
        rec.runIndirect(refine_, *work_size, params,
                        {{"Size", map.size},
                         {"TreeNodes", tree_nodes},
                         {"Photons", map.photons},
                         {"LeafParents", leaf_parents},
                         {"NodeParents", node_parents},
                         {"Sums", sums_},
                         {"WorkSize", *work_size},
                         {"Work", *work},
                         {"NextSize", *next_size},
                         {"Next", *next},
                         {"Members", members_},
                         {"Finals", finals_}});
        rays.close(rec, *next_size);
        std::swap(work, next);
        std::swap(work_size, next_size);
    }
    compaction_.record(rec, members_, ids_, size_, id_count_);
    const bool is_probed = in.probes > 0 && in.mode != CutMode::kNearest;
    rec.runIndirect(
        keys_, size_, NoParams{},
        {{"Size", size_}, {"Ids", ids_}, {"Finals", finals_}, {"Keys", tree_.keys()}, {"Order", tree_.order()}});
    rec.runIndirect(sample_direction_, size_, gpu::SampleDirectionParams{.seed = in.seed, .is_probed = is_probed},
                    {{"CutSize", size_},
                     {"Ids", ids_},
                     {"Size", map.size},
                     {"TreeNodes", tree_nodes},
                     {"Photons", map.photons},
                     {"Sums", sums_},
                     {"Finals", finals_},
                     {"Spheres", spheres_},
                     {"Directions", unsorted_directions_}});
    tree_.recordKeyed(rec, spheres_, size_, gpu::kTreeKeyBits);
    check(in.probes + in.rim_probes <= gpu::kMostProbes, "{} and {} probe rays", in.probes, in.rim_probes);
    const gpu::ProbeParams probing{.ray_count = in.probes, .rim_count = in.rim_probes, .seed = in.seed};
    rays.reset(rec, probe_size_); // an empty cut starts no thread that would set it
    rec.runIndirect(reorder_, size_, probing,
                    {{"Size", size_},
                     {"Ids", ids_},
                     {"Order", tree_.order()},
                     {"Finals", finals_},
                     {"Directions", unsorted_directions_},
                     {"Nodes", nodes_},
                     {"NodeDirections", directions_},
                     {"ProbeSize", probe_size_}});
    if (is_probed)
    {
        rays.count(rec, probe_size_);
        rec.runIndirect(probe_, probe_size_, probing, {{"Size", size_}, {"Nodes", nodes_}});
    }
    return output();
}
