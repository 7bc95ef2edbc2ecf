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
    Gathered sum = Gathered(vec3(0.0), hit.slot == kNone ? 0.0 : state.throughput.x / max(hit.t, 1e-6));
    uint path = ray.path, depth = 0u;
    Passage passage = kNoPassage;
    bool goes_on;
    do // tests at its end: see lib/bvh.glsl why
    {
        GatherVertex vertex = shadeGatherVertex(ray, hit, state, passage, gatherSampler(params, path, depth), false);
        sum.radiance += vertex.radiance;
        goes_on = vertex.goes_on && depth < params.depth_limit;
        if (goes_on)
        {
            ray = vertex.next;
            ++depth;
            hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(hash(params.seed, depth), path));
        }
    } while (goes_on);
    gathered[path] = sum;
}
