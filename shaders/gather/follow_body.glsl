// The body of gather/follow.comp and gather/follow_knn.comp, which differ as their shade kernels do.
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    GatherState state = states[ray.path];
    vec3 radiance = vec3(0.0);
    uint depth = 1u;
    for (;;)
    {
        Hit hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(hash(params.seed, depth), ray.path));
        GatherVertex vertex = shadeGatherVertex(ray, hit, state, gatherSampler(params, ray.path, depth), false);
        radiance += vertex.radiance;
        ray = vertex.next;
        if (!vertex.goes_on || ++depth > params.depth_limit)
            break;
    }
    gathered[ray.path].radiance += radiance;
}
