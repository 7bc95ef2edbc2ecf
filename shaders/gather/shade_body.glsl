// The body of gather/shade.comp and gather/shade_knn.comp, which differ in how they read the light where a ray ends.
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    Hit hit = loadHit(i);
    GatherState state = GatherState(vec3(0.0), kNone, 0u);
    if (hit.slot != kNone) // a ray that gathers for nothing has none
        state = states[ray.path];
    float weight = state.throughput.x;
    uint sample_ = ray.path / params.ray_count;
    Sampler sampler_ = Sampler(hash(params.seed, sample_), ray.path - sample_ * params.ray_count, 1u + params.depth);
    GatherVertex vertex = shadeGatherVertex(ray, hit, state, sampler_, false);
    bool goes_on = vertex.goes_on && params.depth < params.depth_limit;
    if (params.depth == 0u)
        gathered[ray.path] = Gathered(vertex.radiance, hit.slot == kNone ? 0.0 : weight / max(hit.t, 1e-6));
    else
        gathered[ray.path].radiance += vertex.radiance;
    if (!goes_on)
        return;
    states[ray.path] = state;
    next_rays[atomicAdd(next_queue.count, 1u)] = vertex.next;
}
