// A camera that moves: keys, each a camera at a time, and a smooth way between them. The file is described in
// docs/path.md.
#pragma once
#include "runtime/camera.h"

#include <filesystem>

struct CameraKey
{
    double time = 0; // seconds
    Camera camera;
};

class CameraPath
{
public:
    /// Least seconds between keys: nearer ones would need unbounded speeds.
    static constexpr double kLeastStep = 1e-6;

    /// Reads a path. @param cameras of the package, which keys may name
    /// @return kIo where it cannot be opened, kInvalid with a JSON pointer where it is not what it should be
    static Result<CameraPath> load(const std::filesystem::path& path, const std::vector<Camera>& cameras);

    /// The same of the file's text.
    static Result<CameraPath> parse(std::string_view text, const std::vector<Camera>& cameras);

    /// @param keys at least one, in the order of their times, kLeastStep or more apart; cameras as a package has them
    explicit CameraPath(std::vector<CameraKey> keys);

    /// Position and orientation by cubic Hermite curves whose speed at a key is the mean from the key before to the key
    /// after, as Catmull and Rom's: even motion stays even however keys are spaced, and speeds do not jump. Where a key is
    /// as the one before or after it, the camera rests. Fields of view stay within those of the two keys around.
    /// Between a perspective and an orthographic key the projection is that of the earlier.
    /// Before the first key and after the last the camera is theirs, to the last bit.
    Camera at(double seconds) const;

    double start() const { return keys_.front().time; } // seconds
    double end() const { return keys_.back().time; }
    const std::vector<CameraKey>& keys() const { return keys_; }

    /// Writes a file that load() reads, every key with numbers of its own. Errors: kIo.
    Status save(const std::filesystem::path& path) const;

private:
    std::vector<CameraKey> keys_;
};
