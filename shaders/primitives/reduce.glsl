// One level of a segmented reduction of VALUEs; the includer defines VALUE. A thread adds up kReduceItems neighbours in
// their order. Segments that begin and end among them are done; what it has of its first and of its last segment are
// two values of the next level, so that sums are always of the same parts, whoever computes them.

layout(local_size_x = kPrimitivesGroupSize) in;

layout(push_constant, scalar) uniform Push { ReduceParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Segments { uint segments[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Values { VALUE values[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer NextSegments { uint next_segments[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer NextValues { VALUE next_values[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Results { VALUE results[]; };

void finish(uint segment, VALUE sum)
{
    if (segment < params.segment_count)
        results[segment] = sum;
}

void main()
{
    uint count = min(size.count, params.max_count);
    for (uint level = 0u; level < params.level; ++level)
        count = (count + kReduceItems - 1u) / kReduceItems * 2u;
    const uint thread = gl_GlobalInvocationID.x, begin = thread * kReduceItems;
    const uint end = min(begin + kReduceItems, count);
    if (begin >= count)
        return;

    const bool is_last_level = params.is_last_level != 0u;
    uint segment = segments[begin];
    VALUE sum = values[begin];
    bool is_first = true;
    for (uint i = begin + 1u; i < end; ++i)
    {
        const uint next = segments[i];
        const VALUE value = values[i];
        if (next == segment)
        {
            sum += value;
            continue;
        }
        if (is_first && !is_last_level)
        {
            next_segments[2u * thread] = segment;
            next_values[2u * thread] = sum;
        }
        else
            finish(segment, sum);
        is_first = false;
        segment = next;
        sum = value;
    }
    if (is_last_level)
    {
        finish(segment, sum);
        return;
    }
    if (is_first) // one segment only: the second value adds nothing to it
    {
        next_segments[2u * thread] = segment;
        next_values[2u * thread] = sum;
        sum = VALUE(0);
    }
    next_segments[2u * thread + 1u] = segment;
    next_values[2u * thread + 1u] = sum;
}
