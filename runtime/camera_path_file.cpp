// Paths from files: every number is checked before a camera is made of it.
#include "format/bad_json.h"
#include "format/mapped_file.h"
#include "format/vec3d.h"
#include "runtime/camera_path.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <numbers>
#include <span>

namespace
{
using nlohmann::json;

constexpr std::string_view kSchema = "lumicut-path/1";
constexpr double kLongest =
    1e9; // seconds or units of length: far beyond any scene, and floats still tell neighbours apart

Error invalid(std::string_view sentence, std::string_view pointer)
{
    return {ExitCode::kInvalid, fmt::format("{} ({})", sentence, pointer)};
}

Result<json> readJson(std::string_view text)
{
    if (text.starts_with("\xEF\xBB\xBF"))
        text.remove_prefix(3);
    try
    {
        return json::parse(text);
    }
    catch (const json::exception& problem)
    {
        return badJson(problem.what());
    }
}

/// @return kInvalid where `object` is none or has a member that is not among `names`: a slip of the pen would go
/// unnoticed
Status checkMembers(const json& object, std::span<const std::string_view> names, const std::string& pointer)
{
    if (!object.is_object())
        return invalid("an object is expected", pointer.empty() ? "/" : pointer);
    for (const auto& [name, value] : object.items())
        if (std::ranges::find(names, name) == names.end())
            return invalid(
                fmt::format("'{}' is unknown here; known are {}", name.substr(0, 40), fmt::join(names, ", ")),
                pointer + "/" + name.substr(0, 40));
    return Success{};
}

/// Reads the members of one key.
class KeyReader
{
public:
    KeyReader(const json& key, size_t index) : key_(key), pointer_(fmt::format("/keys/{}", index)) {}

    Result<CameraKey> read(const std::vector<Camera>& cameras) const;

private:
    std::string pointerTo(const char* name) const { return pointer_ + "/" + name; }
    Result<double> number(const char* name, double least, double most) const;
    Result<Vec3d> vector(const char* name) const;
    Status readNumber(const char* name, double least, double most, float& value) const;
    Result<Camera> packageCamera(const std::vector<Camera>& cameras) const;
    Result<Camera> ownCamera() const;
    Status readOrientation(Camera& camera) const;
    Status readLens(Camera& camera) const;

    const json& key_;
    std::string pointer_;
};

Result<double> KeyReader::number(const char* name, double least, double most) const
{
    const auto found = key_.find(name);
    if (found == key_.end())
        return invalid(fmt::format("this key has no {}", name), pointerTo(name));
    if (!found->is_number() || !(found->get<double>() >= least && found->get<double>() <= most))
        return invalid(fmt::format("the {} must be a number from {} to {}", name, least, most), pointerTo(name));
    return found->get<double>();
}

/// Leaves `value` unchanged if the key does not have the member.
Status KeyReader::readNumber(const char* name, double least, double most, float& value) const
{
    if (!key_.contains(name))
        return Success{};
    const Result<double> read = number(name, least, most);
    if (!read)
        return read.error();
    value = float(*read);
    return Success{};
}

Result<Vec3d> KeyReader::vector(const char* name) const
{
    const auto found = key_.find(name);
    if (found == key_.end())
        return invalid(fmt::format("this key has neither a camera nor a {}", name), pointerTo(name));
    const auto fits = [](const json& v) { return v.is_number() && std::fabs(v.get<double>()) <= kLongest; };
    if (!found->is_array() || found->size() != 3 || !std::ranges::all_of(*found, fits))
        return invalid(fmt::format("the {} must be three numbers from {} to {}", name, -kLongest, kLongest),
                       pointerTo(name));
    return Vec3d{(*found)[0], (*found)[1], (*found)[2]};
}

Status KeyReader::readOrientation(Camera& camera) const
{
    const Result<Vec3d> forward = vector("forward");
    if (!forward)
        return forward.error();
    const Result<Vec3d> up = key_.contains("up") ? vector("up") : Vec3d{0, 1, 0};
    if (!up)
        return up.error();
    const Vec3d ahead = unitOrZero(*forward), above = unitOrZero(*up);
    if (ahead == Vec3d{})
        return invalid("the forward vector must not be zero", pointerTo("forward"));
    const Vec3d right = cross(ahead, above);
    if (length(right) < 1e-6) // of the sine between them: floats tell no smaller one from none
        return invalid("the up vector must not be zero nor along the forward vector", pointerTo("up"));
    camera.forward = toFloat(ahead);
    camera.up = toFloat(cross(unitOrZero(right), ahead));
    return Success{};
}

Status KeyReader::readLens(Camera& camera) const
{
    // The narrowest and widest whose tangents floats hold with a reserve.
    constexpr double kNarrowest = 1e-4, kWidest = std::numbers::pi - 1e-3;
    if (key_.contains("orthographic_height"))
    {
        if (key_.contains("vertical_fov"))
            return invalid("vertical_fov and orthographic_height exclude each other", pointerTo("orthographic_height"));
        camera.vertical_fov = 0;
    }
    if (const Status status = readNumber("vertical_fov", kNarrowest, kWidest, camera.vertical_fov); !status)
        return status;
    if (const Status status = readNumber("orthographic_height", 1e-9, kLongest, camera.orthographic_height); !status)
        return status;
    if (const Status status = readNumber("near_plane", 0, kLongest, camera.near_plane); !status)
        return status;
    if (const Status status = readNumber("far_plane", 0, kLongest, camera.far_plane); !status)
        return status;
    if (camera.far_plane > 0 && camera.far_plane <= camera.near_plane)
        return invalid("the far plane must lie behind the near plane; 0 is none", pointerTo("far_plane"));
    return Success{};
}

Result<Camera> KeyReader::ownCamera() const
{
    Camera camera;
    const Result<Vec3d> position = vector("position");
    if (!position)
        return position.error();
    camera.position = toFloat(*position);
    if (const Status status = readOrientation(camera); !status)
        return status.error();
    if (const Status status = readLens(camera); !status)
        return status.error();
    return camera;
}

Result<Camera> KeyReader::packageCamera(const std::vector<Camera>& cameras) const
{
    const json& camera = key_["camera"];
    if (key_.size() > 2)
        return invalid("a key with a camera of the package has nothing else but its time", pointer_);
    if (!camera.is_string() && !camera.is_number_unsigned())
        return invalid("a camera is named by its name or its index", pointerTo("camera"));
    const std::string name = camera.is_string() ? camera.get<std::string>() : fmt::format("{}", camera.get<uint64_t>());
    if (camera.is_number_unsigned() && camera.get<uint64_t>() < cameras.size())
        return cameras[camera.get<size_t>()]; // a camera may have a number for its name, and that of another
    if (const auto named = camera.is_string() ? findCamera(cameras, name) : std::nullopt)
        return cameras[*named];
    return invalid(noCamera(cameras, name), pointerTo("camera"));
}

Result<CameraKey> KeyReader::read(const std::vector<Camera>& cameras) const
{
    constexpr std::string_view kMembers[] = {
        "time",       "camera",   "position", "forward", "up", "vertical_fov", "orthographic_height",
        "near_plane", "far_plane"};
    if (const Status status = checkMembers(key_, kMembers, pointer_); !status)
        return status.error();
    const Result<double> time = number("time", -kLongest, kLongest);
    if (!time)
        return time.error();
    const Result<Camera> camera = key_.contains("camera") ? packageCamera(cameras) : ownCamera();
    if (!camera)
        return camera.error();
    return CameraKey{*time, *camera};
}

Result<std::vector<CameraKey>> readKeys(const json& document, const std::vector<Camera>& cameras)
{
    constexpr std::string_view kMembers[] = {"$schema", "schema", "keys"};
    if (const Status status = checkMembers(document, kMembers, ""); !status)
        return status.error();
    if (!document.contains("schema") || document["schema"] != kSchema)
        return invalid(fmt::format("it does not say that it is a path, by \"schema\": \"{}\"", kSchema), "/schema");
    if (!document.contains("keys") || !document["keys"].is_array() || document["keys"].empty())
        return invalid("a path needs an array of one key or more", "/keys");
    std::vector<CameraKey> keys;
    for (const json& key : document["keys"])
    {
        const Result<CameraKey> read = KeyReader(key, keys.size()).read(cameras);
        if (!read)
            return read.error();
        if (!keys.empty() && !(read->time - keys.back().time >= CameraPath::kLeastStep))
            return invalid(fmt::format("the time must be {} s or more after that of the key before, {} s",
                                       CameraPath::kLeastStep, keys.back().time),
                           fmt::format("/keys/{}/time", keys.size()));
        keys.push_back(*read);
    }
    return keys;
}
} // namespace

Result<CameraPath> CameraPath::parse(std::string_view text, const std::vector<Camera>& cameras)
{
    const Result<json> document = readJson(text);
    if (!document)
        return document.error();
    auto keys = readKeys(*document, cameras);
    if (!keys)
        return keys.error();
    return CameraPath(std::move(*keys));
}

Result<CameraPath> CameraPath::load(const std::filesystem::path& path, const std::vector<Camera>& cameras)
{
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error().about(path.string());
    const std::span<const std::byte> bytes = file->bytes();
    auto read = parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, cameras);
    if (!read)
        return read.error().about(path.string());
    return read;
}
