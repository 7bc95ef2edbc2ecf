// A digit of a key of one or two words, the low one in x.

uint digitOf(uvec2 key, uint first_bit, uint bits)
{
    const uint shift = first_bit & 31u;
    const uint low = first_bit < 32u ? key.x : key.y;
    const uint rest = first_bit < 32u && shift > 0u ? key.y << (32u - shift) : 0u; // where the digit crosses the words
    return ((low >> shift) | rest) & ((1u << bits) - 1u);
}
