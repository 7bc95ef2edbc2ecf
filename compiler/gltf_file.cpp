#include "compiler/gltf_file.h"

#include "compiler/gltf_buffers.h"
#include "compiler/gltf_document.h"
#include "compiler/gltf_extensions.h"
#include "compiler/gltf_repair.h"

#include <fmt/format.h>

#include <algorithm>

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

namespace
{
Result<std::vector<GltfImage>> takeImages(json& document)
{
    std::vector<GltfImage> images;
    const auto list = document.find("images");
    if (list == document.end())
        return images;
    for (size_t i = 0; i < list->size(); ++i)
    {
        const json& from = (*list)[i];
        const auto text = [&](const char* key)
        { return from.contains(key) && from[key].is_string() ? from[key].get<std::string>() : std::string(); };
        GltfImage image{text("name"), text("uri"), -1};
        if (const auto view = from.find("bufferView"); view != from.end() && view->is_number_integer())
            image.buffer_view = view->get<int>();
        if (!image.uri.empty() && !isDataUri(image.uri))
            image.name = image.uri;
        if (image.name.empty())
            image.name = fmt::format("image {}", i);
        images.push_back(std::move(image));
    }
    document.erase("images");
    return images;
}

/// tinygltf takes a skin without inverse bind matrices for damaged.
std::vector<GltfSkin> takeSkins(json& document)
{
    std::vector<GltfSkin> skins;
    const auto list = document.find("skins");
    if (list == document.end())
        return skins;
    const auto integer = [](const json& value) { return value.is_number_integer() ? value.get<int>() : -1; };
    for (const json& from : *list)
    {
        GltfSkin& skin = skins.emplace_back();
        if (const auto name = from.find("name"); name != from.end() && name->is_string())
            skin.name = name->get<std::string>();
        if (const auto joints = from.find("joints"); joints != from.end() && joints->is_array())
            for (const json& joint : *joints)
                skin.joints.push_back(integer(joint));
        if (const auto matrices = from.find("inverseBindMatrices"); matrices != from.end())
            skin.inverse_bind_matrices = integer(*matrices);
    }
    document.erase("skins");
    return skins;
}

GltfChannel readChannel(const json& channel, const json& samplers)
{
    const auto member = [](const json& from, const char* key) -> json
    { return from.is_object() && from.contains(key) ? from[key] : json(); };
    const auto integer = [&](const json& from, const char* key)
    {
        const json value = member(from, key);
        return value.is_number_unsigned() ? int(std::min<uint64_t>(value.get<uint64_t>(), INT32_MAX)) : -1;
    };
    const auto text = [&](const json& from, const char* key, const char* fallback)
    {
        const json value = member(from, key);
        return value.is_string() ? value.get<std::string>() : std::string(fallback);
    };
    const json target = member(channel, "target");
    GltfChannel result;
    result.path = text(target, "path", "");
    result.node = integer(target, "node");
    result.pointer = text(member(member(target, "extensions"), "KHR_animation_pointer"), "pointer", "");
    const int sampler = integer(channel, "sampler");
    if (!samplers.is_array() || sampler < 0 || size_t(sampler) >= samplers.size())
        return result;
    const json& keys = samplers[size_t(sampler)];
    result.interpolation = text(keys, "interpolation", "LINEAR");
    result.times = integer(keys, "input");
    result.values = integer(keys, "output");
    return result;
}

/// tinygltf does without what we read ourselves.
std::vector<GltfAnimation> takeAnimations(json& document)
{
    std::vector<GltfAnimation> animations;
    const auto list = document.find("animations");
    if (list == document.end())
        return animations;
    for (const json& from : *list)
    {
        GltfAnimation& animation = animations.emplace_back();
        if (const auto name = from.find("name"); name != from.end() && name->is_string())
            animation.name = name->get<std::string>();
        const json samplers = from.contains("samplers") ? from["samplers"] : json();
        if (const auto channels = from.find("channels"); channels != from.end() && channels->is_array())
            for (const json& channel : *channels)
                animation.channels.push_back(readChannel(channel, samplers));
    }
    document.erase("animations");
    return animations;
}

/// tinygltf refuses index accessors without a buffer view, which Draco files and sparse ones over zeros have: lends
/// them the first one. @return the accessors that got it
std::vector<size_t> lendIndexViews(json& document)
{
    std::vector<size_t> lent;
    const auto accessors = document.find("accessors");
    const auto views = document.find("bufferViews");
    const auto meshes = document.find("meshes");
    if (accessors == document.end() || views == document.end() || views->empty() || meshes == document.end())
        return lent;
    for (const json& mesh : *meshes)
    {
        const auto primitives = mesh.find("primitives");
        if (primitives == mesh.end() || !primitives->is_array())
            continue;
        for (const json& primitive : *primitives)
        {
            const auto indices = primitive.is_object() ? primitive.find("indices") : primitive.end();
            if (indices == primitive.end() || !indices->is_number_unsigned() ||
                indices->get<size_t>() >= accessors->size())
                continue;
            json& accessor = (*accessors)[indices->get<size_t>()];
            if (accessor.contains("bufferView"))
                continue;
            accessor["bufferView"] = 0;
            lent.push_back(indices->get<size_t>());
        }
    }
    return lent;
}

/// Lets tinygltf take buffers that are read already: their URI is their number.
struct LoadedBuffers
{
    std::vector<Bytes> buffers;

    static bool exists(const std::string&, void*) { return true; }
    static std::string expand(const std::string& path, void*) { return path; }
    static bool read(Bytes* out, std::string*, const std::string& path, void* user)
    {
        auto& buffers = static_cast<LoadedBuffers*>(user)->buffers;
        *out = std::move(buffers.at(std::stoul(path.substr(path.find_last_of('/') + 1))));
        return true;
    }
};

Status parseModel(const json& document, LoadedBuffers buffers, tinygltf::Model& model)
{
    std::string error;
    std::string warning;
    bool ok = false;
    try
    {
        const std::string text = document.dump();
        tinygltf::TinyGLTF loader;
        loader.SetFsCallbacks(
            {&LoadedBuffers::exists, &LoadedBuffers::expand, &LoadedBuffers::read, nullptr, &buffers});
        ok = loader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "buffers");
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (const std::exception& e)
    {
        error = e.what();
    }
    if (ok)
        return Success{};
    std::replace(error.begin(), error.end(), '\n', ' ');
    while (!error.empty() && error.back() == ' ')
        error.pop_back();
    return Error{ExitCode::kInvalid, fmt::format("it is no valid glTF: {}", error.empty() ? "unknown reason" : error)};
}
} // namespace

Result<GltfFile> readGltf(const std::filesystem::path& path)
{
    GltfFile file;
    file.files = std::make_shared<InputFiles>(path.parent_path());
    const Result<Bytes> bytes = file.files->read(path.filename().string());
    if (!bytes)
        return bytes.error();
    Result<GltfDocument> parsed = parseDocument(*bytes);
    if (!parsed)
        return parsed.error();
    json& document = parsed->json;
    repairGltf(document, file.warnings);
    if (const Status status = checkExtensions(document, file.warnings); !status)
        return status.error();
    file.animations = takeAnimations(document);
    file.skins = takeSkins(document);

    Result<std::vector<Bytes>> buffers = loadBuffers(*parsed, *file.files, file.warnings);
    if (!buffers)
        return buffers.error();
    Result<std::vector<GltfImage>> images = takeImages(document);
    if (!images)
        return images.error();
    file.images = std::move(*images);
    const std::vector<size_t> lent = lendIndexViews(document);
    if (const Status status = parseModel(document, LoadedBuffers{std::move(*buffers)}, file.model); !status)
        return status.error();
    for (const size_t accessor : lent)
        file.model.accessors[accessor].bufferView = -1;
    return file;
}

Result<ByteView> viewBytes(const tinygltf::Model& model, int buffer_view)
{
    if (buffer_view < 0 || size_t(buffer_view) >= model.bufferViews.size())
        return Error{ExitCode::kInvalid, fmt::format("buffer view {} does not exist", buffer_view)};
    const tinygltf::BufferView& view = model.bufferViews[size_t(buffer_view)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        return Error{ExitCode::kInvalid,
                     fmt::format("buffer {} does not exist (/bufferViews/{}/buffer)", view.buffer, buffer_view)};
    const auto& data = model.buffers[size_t(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        return Error{ExitCode::kInvalid,
                     fmt::format("a buffer view reaches past the end of its buffer (/bufferViews/{})", buffer_view)};
    return ByteView{data.data() + view.byteOffset, view.byteLength, view.byteStride};
}
