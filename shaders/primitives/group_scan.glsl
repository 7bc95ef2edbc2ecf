// Sums over the threads of a workgroup of kPrimitivesGroupSize, in shared memory and for any subgroup size.

const uint kScanRow = 16u; // threads; kPrimitivesGroupSize is its square

shared uint s_scan[kPrimitivesGroupSize];
shared uint s_scan_rows[kScanRow];

/// The sum of `x` over all threads before this one; `total` is that over all threads. Called by every thread.
uint groupExclusiveSum(uint x, out uint total)
{
    const uint thread = gl_LocalInvocationIndex, first = thread & ~(kScanRow - 1u);
    barrier(); // what the call before has read may be overwritten
    s_scan[thread] = x;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < kScanRow - 1u; ++i)
        before += first + i < thread ? s_scan[first + i] : 0u;
    if (thread - first == kScanRow - 1u)
        s_scan_rows[thread / kScanRow] = before + x;
    barrier();
    total = 0u;
    for (uint i = 0u; i < kScanRow; ++i)
    {
        const uint row = s_scan_rows[i];
        before += i < thread / kScanRow ? row : 0u;
        total += row;
    }
    return before;
}
