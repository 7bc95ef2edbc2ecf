// How a count is divided among workers: contiguous shares of whole tiles, the first to the first worker.

uint shareOf(uint count, uint worker_count, uint tile)
{
    const uint even = (count + worker_count - 1u) / worker_count;
    return max((even + tile - 1u) / tile, 1u) * tile;
}
