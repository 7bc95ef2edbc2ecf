#include "tools/bench/sequence_metrics.h"

#include "format/check.h"

#include <algorithm>

FlipMap SequenceMetrics::add(SequenceFrame frame)
{
    FlipMap flip = ldrFlip(frame.reference, frame.picture);
    flip_.push_back(flip.mean);
    for (size_t distance = 1; distance <= last_.size(); ++distance)
        compare(frame, distance, flip);
    last_.push_front(std::move(frame));
    if (last_.size() > kDistances)
        last_.pop_back();
    return flip;
}

double SequenceMetrics::meanFlip() const
{
    Mean mean;
    for (const double flip : flip_)
        mean.add(flip);
    return mean.value();
}

void SequenceMetrics::compare(const SequenceFrame& frame, size_t distance, const FlipMap& flip)
{
    const SequenceFrame& then = last_[distance - 1];
    check(frame.plain.size() == frame.hits.hits.size(), "{} of {} pixels", frame.plain.size(), frame.hits.hits.size());
    const std::vector<PicturePoint> places = reproject(frame.hits, then.hits);
    // Pixels that were not seen keep what they show, so that FLIP's filters spread no difference from them to their neighbours.
    const FlipMap pictures = ldrFlip(frame.picture, warp(then.picture, places, frame.picture));
    const FlipMap references = ldrFlip(frame.reference, warp(then.reference, places, frame.reference));
    for (size_t i = 0; i < places.size(); ++i)
    {
        if (!places[i].isSeen())
        {
            if (distance == 1)
                unseen_flip_.add(double(flip.error[i]));
            continue;
        }
        for (Flicker* flicker : {&flicker_[distance - 1], frame.plain[i] ? &plain_flicker_[distance - 1] : nullptr})
        {
            if (!flicker)
                continue;
            flicker->pictures.add(double(pictures.error[i]));
            flicker->references.add(double(references.error[i]));
        }
    }
    if (distance == 1)
        pixel_count_ += places.size();
}

void excludeCaustics(std::vector<uint8_t>& plain, const ImageF& all, const ImageF& caustics)
{
    check(plain.size() == all.pixelCount() && plain.size() == caustics.pixelCount(), "{}, {} and {} pixels",
          plain.size(), all.pixelCount(), caustics.pixelCount());
    constexpr float kShare = 0.01f;
    constexpr uint32_t kReach = 3; // pixels
    for (uint32_t y = 0; y < all.height; ++y)
        for (uint32_t x = 0; x < all.width; ++x)
        {
            float light = 0, caustic = 0;
            for (uint32_t row = y - std::min(y, kReach); row <= std::min(y + kReach, all.height - 1); ++row)
                for (uint32_t i = 3 * (row * all.width + x - std::min(x, kReach));
                     i < 3 * (row * all.width + std::min(x + kReach, all.width - 1) + 1); ++i)
                {
                    light += all.rgb[i];
                    caustic += caustics.rgb[i];
                }
            if (caustic > kShare * light)
                plain[size_t(y) * all.width + x] = 0;
        }
}
