#include "tools/bench/sequence_metrics.h"

#include "format/check.h"

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
