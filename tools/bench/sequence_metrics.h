// How far the pictures of a moving camera are from their references, and how much they flicker.
#pragma once
#include "tools/bench/reproject.h"
#include "tools/compare/flip.h"

#include <array>
#include <deque>

/// Mean of what was added, 0 where nothing was.
struct Mean
{
    double sum = 0;
    uint64_t count = 0;

    void add(double value)
    {
        sum += value;
        ++count;
    }
    double value() const { return count ? sum / double(count) : 0; }
};

struct SequenceFrame
{
    ImageF picture, reference; // as a display shows them: linear, 0..1
    FirstHits hits;
    std::vector<uint8_t> plain; // [pixels]: neither a mirror, nor glass, nor a caustic; a sharp reflection moves
                                // otherwise than the surface that it is in
};

/// Takes the pixels out of `plain` around which, three pixels far, caustics are more than a hundredth of the light:
/// their picture may be noisy. All are of one size.
void excludeCaustics(std::vector<uint8_t>& plain, const ImageF& all, const ImageF& caustics);

/// Mean LDR-FLIP between a frame and an earlier one warped onto it, over the pixels that were seen then.
struct Flicker
{
    Mean pictures, references;

    /// What the pictures flicker more than their references, which are warped and noisy too.
    double value() const { return pictures.value() - references.value(); }
};

class SequenceMetrics
{
public:
    static constexpr size_t kDistances = 3; // frames between those compared for flicker: 1, 2, 3

    /// The next frame. All are of one size. @return its FLIP against its reference
    FlipMap add(SequenceFrame frame);

    const std::vector<double>& flip() const { return flip_; } // of each frame
    double meanFlip() const;
    /// Of frames `distance` apart, 1 to kDistances.
    const Flicker& flicker(size_t distance) const { return flicker_[distance - 1]; }
    /// The same in plain pixels alone.
    const Flicker& plainFlicker(size_t distance) const { return plain_flicker_[distance - 1]; }
    /// FLIP against the reference in pixels that the frame before did not show.
    const Mean& unseenFlip() const { return unseen_flip_; }
    /// Pixels that the frame before did not show, of all.
    double unseenShare() const { return pixel_count_ ? double(unseen_flip_.count) / double(pixel_count_) : 0; }

private:
    void compare(const SequenceFrame& frame, size_t distance, const FlipMap& flip);

    std::deque<SequenceFrame> last_; // the latest first, kDistances at most
    std::vector<double> flip_;
    std::array<Flicker, kDistances> flicker_, plain_flicker_;
    Mean unseen_flip_;
    uint64_t pixel_count_ = 0; // of frames with one before them
};
