#include "tools/scenes/gltf_writer.h"

#include "format/check.h"
#include "image/write_image.h"

#include <cstring>

namespace
{

constexpr int kFloat = 5126, kUint = 5125, kUshort = 5123;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

using Json = nlohmann::ordered_json;

Json triple(Vec3 v)
{
    return {v.x, v.y, v.z};
}

bool isZero(Vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

void appendUint(std::vector<uint8_t>& bytes, uint32_t value)
{
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(uint8_t(value >> shift));
}

std::vector<uint8_t> withAlpha(const Texture& texture)
{
    std::vector<uint8_t> rgba;
    for (size_t i = 0; i < texture.alpha.size(); ++i)
        rgba.insert(rgba.end(), {texture.rgb[3 * i], texture.rgb[3 * i + 1], texture.rgb[3 * i + 2], texture.alpha[i]});
    return rgba;
}

/// Quaternion that turns -Z to `forward` with +Y up as far as possible.
Json lookRotation(Vec3 forward)
{
    const Vec3 z = -normalize(forward);
    const Vec3 up = std::abs(z.y) > 0.999f ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 x = normalize(cross(up, z));
    const Vec3 y = cross(z, x);
    // The largest of the four squared components is found first: no division by a small number.
    const float squares[4] = {1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z, 1 + x.x + y.y + z.z};
    int largest = 0;
    for (int i = 1; i < 4; ++i)
        if (squares[i] > squares[largest])
            largest = i;
    const float s = 0.5f / std::sqrt(squares[largest]);
    const float a = squares[largest] * s;
    const float yz = (y.z - z.y) * s, zx = (z.x - x.z) * s, xy = (x.y - y.x) * s;
    const float sxy = (x.y + y.x) * s, syz = (y.z + z.y) * s, szx = (z.x + x.z) * s;
    switch (largest)
    {
    case 0:
        return {a, sxy, szx, yz};
    case 1:
        return {sxy, a, syz, zx};
    case 2:
        return {szx, syz, a, xy};
    default:
        return {yz, zx, xy, a};
    }
}

} // namespace

GltfWriter::GltfWriter()
{
    json_["asset"] = {{"version", "2.0"}, {"generator", "lumicut-scenes"}, {"copyright", "CC0 1.0"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", Json::array()}}});
}

void GltfWriter::useExtension(const std::string& name)
{
    Json& used = json_["extensionsUsed"];
    for (const Json& known : used)
        if (known == name)
            return;
    used.push_back(name);
}

uint32_t GltfWriter::addView(const void* data, size_t bytes, int target)
{
    while (binary_.size() % 4 != 0)
        binary_.push_back(0);
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
    if (target != 0)
        view["target"] = target;
    const auto* first = static_cast<const uint8_t*>(data);
    binary_.insert(binary_.end(), first, first + bytes);
    json_["bufferViews"].push_back(view);
    return uint32_t(json_["bufferViews"].size() - 1);
}

uint32_t GltfWriter::addAccessor(const void* data, size_t count, size_t components, int component_type, int target)
{
    const char* const type = components == 1   ? "SCALAR"
                             : components == 2 ? "VEC2"
                             : components == 3 ? "VEC3"
                             : components == 4 ? "VEC4"
                                               : "MAT4";
    const uint32_t view = addView(data, count * components * (component_type == kUshort ? 2 : 4), target);
    json_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
    return uint32_t(json_["accessors"].size() - 1);
}

uint32_t GltfWriter::addTexture(const std::string& name, const Texture& texture)
{
    const std::vector<uint8_t> png = texture.alpha.empty()
                                         ? encodePng(texture.size, texture.size, 3, texture.rgb)
                                         : encodePng(texture.size, texture.size, 4, withAlpha(texture));
    const uint32_t view = addView(png.data(), png.size(), 0);
    json_["images"].push_back({{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
    if (!json_.contains("samplers"))
        json_["samplers"] = Json::array({{{"magFilter", 9729}, {"minFilter", 9987}}}); // linear, trilinear, repeat
    json_["textures"].push_back({{"sampler", 0}, {"source", json_["images"].size() - 1}});
    return uint32_t(json_["textures"].size() - 1);
}

uint32_t GltfWriter::addMaterial(const MaterialDescription& material)
{
    Json pbr = {{"baseColorFactor", {material.base_color.x, material.base_color.y, material.base_color.z, 1}},
                {"metallicFactor", material.metallic},
                {"roughnessFactor", material.roughness}};
    if (material.base_color_texture)
        pbr["baseColorTexture"] = {{"index", *material.base_color_texture}};
    if (material.metallic_roughness_texture)
        pbr["metallicRoughnessTexture"] = {{"index", *material.metallic_roughness_texture}};
    Json json = {{"name", material.name}, {"pbrMetallicRoughness", pbr}};
    if (material.normal_texture)
        json["normalTexture"] = {{"index", *material.normal_texture}, {"scale", material.normal_scale}};
    if (material.double_sided)
        json["doubleSided"] = true;
    if (material.alpha_cutoff)
    {
        json["alphaMode"] = "MASK";
        json["alphaCutoff"] = *material.alpha_cutoff;
    }

    const auto extend = [&](const char* name, const Json& values)
    {
        useExtension(name);
        json["extensions"][name] = values;
    };
    if (!isZero(material.emission))
    {
        const float strength = std::max({material.emission.x, material.emission.y, material.emission.z});
        json["emissiveFactor"] = triple(material.emission * (1 / strength));
        extend("KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
    }
    if (material.lambert)
        extend("KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {0, 0, 0}}});
    if (material.ior != 1.5f || material.transmission > 0)
        extend("KHR_materials_ior", {{"ior", material.ior}});
    if (material.transmission > 0)
        extend("KHR_materials_transmission", {{"transmissionFactor", material.transmission}});
    if (material.thickness > 0)
    {
        Json volume = {{"thicknessFactor", material.thickness}};
        if (material.attenuation_color)
        {
            volume["attenuationColor"] = triple(*material.attenuation_color);
            volume["attenuationDistance"] = material.attenuation_distance;
        }
        extend("KHR_materials_volume", volume);
    }
    for (const auto& [name, values] : material.extensions.items())
        extend(name.c_str(), values);
    json_["materials"].push_back(json);
    return uint32_t(json_["materials"].size() - 1);
}

uint32_t GltfWriter::addMesh(const std::string& name, const Mesh& mesh, uint32_t material)
{
    check(!mesh.indices.empty() && mesh.positions.size() == mesh.normals.size() &&
              mesh.positions.size() == mesh.uvs.size(),
          "mesh {} has {} indices, {} positions, {} normals, {} uvs", name, mesh.indices.size(), mesh.positions.size(),
          mesh.normals.size(), mesh.uvs.size());
    const size_t count = mesh.positions.size();
    const uint32_t positions = addAccessor(mesh.positions.data(), count, 3, kFloat, kArrayBuffer);
    Vec3 low = mesh.positions[0], high = low;
    for (Vec3 p : mesh.positions)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    json_["accessors"][positions]["min"] = triple(low);
    json_["accessors"][positions]["max"] = triple(high);
    const uint32_t normals = addAccessor(mesh.normals.data(), count, 3, kFloat, kArrayBuffer);
    const uint32_t uvs = addAccessor(mesh.uvs.data(), count, 2, kFloat, kArrayBuffer);
    const uint32_t indices = addAccessor(mesh.indices.data(), mesh.indices.size(), 1, kUint, kElementArrayBuffer);
    Json primitive = {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}},
                      {"indices", indices},
                      {"material", material}};
    json_["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    mesh_triangles_.push_back(mesh.indices.size() / 3);
    return uint32_t(mesh_triangles_.size() - 1);
}

void GltfWriter::addRoot(Json node)
{
    json_["nodes"].push_back(std::move(node));
    json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
}

uint32_t GltfWriter::addNode(const std::string& name, uint32_t mesh, Vec3 translation, float turn_about_y)
{
    Json node = {{"name", name}, {"mesh", mesh}};
    if (!isZero(translation))
        node["translation"] = triple(translation);
    if (turn_about_y != 0)
        node["rotation"] = {0, std::sin(turn_about_y / 2), 0, std::cos(turn_about_y / 2)};
    addRoot(std::move(node));
    triangle_count_ += mesh_triangles_[mesh];
    return uint32_t(json_["nodes"].size() - 1);
}

uint32_t GltfWriter::group(const std::string& name, size_t count, Vec3 translation)
{
    Json& roots = json_["scenes"][0]["nodes"];
    check(count <= roots.size(), "{} of {} roots", count, roots.size());
    Json node = {{"name", name}};
    if (!isZero(translation))
        node["translation"] = triple(translation);
    node["children"] = Json(roots.end() - std::ptrdiff_t(count), roots.end());
    roots.erase(roots.end() - std::ptrdiff_t(count), roots.end());
    addRoot(std::move(node));
    return uint32_t(json_["nodes"].size() - 1);
}

std::vector<uint32_t> GltfWriter::addSkinned(const std::string& name, const Mesh& mesh, uint32_t material,
                                             const std::vector<Joint>& joints,
                                             const std::vector<std::array<float, 4>>& weights,
                                             const std::vector<std::array<uint16_t, 4>>& joints_of_vertex)
{
    check(weights.size() == mesh.positions.size() && joints_of_vertex.size() == weights.size(), "{} weights",
          weights.size());
    const uint32_t index = addMesh(name, mesh, material);
    primitive(index)["attributes"]["JOINTS_0"] =
        addAccessor(joints_of_vertex.data(), weights.size(), 4, kUshort, kArrayBuffer);
    primitive(index)["attributes"]["WEIGHTS_0"] = addAccessor(weights.data(), weights.size(), 4, kFloat, kArrayBuffer);
    std::vector<uint32_t> nodes;
    std::vector<Vec3> places;
    std::vector<float> inverse_binds;
    for (const Joint& joint : joints)
    {
        const Json node = {{"name", joint.name}, {"translation", triple(joint.translation)}};
        places.push_back(joint.parent < 0 ? joint.translation : places[size_t(joint.parent)] + joint.translation);
        nodes.push_back(uint32_t(json_["nodes"].size()));
        if (joint.parent < 0)
            addRoot(node);
        else
        {
            json_["nodes"].push_back(node);
            json_["nodes"][nodes[size_t(joint.parent)]]["children"].push_back(nodes.back());
        }
        const Vec3 p = -places.back();
        inverse_binds.insert(inverse_binds.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1});
    }
    json_["skins"].push_back(
        {{"name", name},
         {"joints", nodes},
         {"inverseBindMatrices", addAccessor(inverse_binds.data(), joints.size(), 16, kFloat, 0)}});
    const uint32_t node = addNode(name, index);
    json_["nodes"][node]["skin"] = json_["skins"].size() - 1;
    return nodes;
}

void GltfWriter::animate(uint32_t node, const char* path, const std::vector<float>& times,
                         const std::vector<float>& values)
{
    check(!times.empty() && values.size() % times.size() == 0, "{} values at {} times", values.size(), times.size());
    Json& animations = json_["animations"];
    if (animations.empty())
        animations.push_back({{"name", "motion"}, {"channels", Json::array()}, {"samplers", Json::array()}});
    const uint32_t input = addAccessor(times.data(), times.size(), 1, kFloat, 0);
    json_["accessors"][input]["min"] = {times.front()};
    json_["accessors"][input]["max"] = {times.back()};
    const uint32_t output = addAccessor(values.data(), times.size(), values.size() / times.size(), kFloat, 0);
    Json& animation = json_["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

void GltfWriter::addCamera(const std::string& name, Vec3 eye, Vec3 target, float vertical_fov)
{
    json_["cameras"].push_back(
        {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", vertical_fov}, {"znear", 0.01}}}});
    addRoot({{"name", name},
             {"camera", json_["cameras"].size() - 1},
             {"translation", triple(eye)},
             {"rotation", lookRotation(target - eye)}});
}

void GltfWriter::addLight(Json light, Json node)
{
    useExtension("KHR_lights_punctual");
    Json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    node["extensions"] = {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}};
    addRoot(std::move(node));
}

void GltfWriter::addSun(const std::string& name, Vec3 travels, Vec3 color, float irradiance)
{
    addLight({{"name", name}, {"type", "directional"}, {"color", triple(color)}, {"intensity", irradiance}},
             {{"name", name}, {"rotation", lookRotation(travels)}});
}

void GltfWriter::addPoint(const std::string& name, Vec3 position, Vec3 color, float intensity)
{
    addLight({{"name", name}, {"type", "point"}, {"color", triple(color)}, {"intensity", intensity}},
             {{"name", name}, {"translation", triple(position)}});
}

void GltfWriter::addSpot(const std::string& name, Vec3 position, Vec3 shines, Vec3 color, float intensity, float inner,
                         float outer)
{
    addLight({{"name", name},
              {"type", "spot"},
              {"color", triple(color)},
              {"intensity", intensity},
              {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}},
             {{"name", name}, {"translation", triple(position)}, {"rotation", lookRotation(shines)}});
}

void GltfWriter::place(const std::string& name, const std::array<double, 3>& translation, double scale)
{
    Json node = {{"name", name}, {"translation", translation}};
    if (scale != 1)
        node["scale"] = {scale, scale, scale};
    node["children"] = std::move(json_["scenes"][0]["nodes"]);
    json_["scenes"][0]["nodes"] = Json::array();
    addRoot(std::move(node));
    for (Json& camera : json_["cameras"])
        camera["perspective"]["znear"] = scale * camera["perspective"]["znear"].get<double>();
}

std::vector<uint8_t> GltfWriter::glb() const
{
    std::vector<uint8_t> binary = binary_;
    while (binary.size() % 4 != 0)
        binary.push_back(0);
    Json json = json_;
    json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');

    std::vector<uint8_t> bytes = {'g', 'l', 'T', 'F'};
    appendUint(bytes, 2);
    appendUint(bytes, uint32_t(12 + 8 + text.size() + 8 + binary.size()));
    appendUint(bytes, uint32_t(text.size()));
    appendUint(bytes, 0x4e4f534a); // "JSON"
    bytes.insert(bytes.end(), text.begin(), text.end());
    appendUint(bytes, uint32_t(binary.size()));
    appendUint(bytes, 0x004e4942); // "BIN"
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return bytes;
}
