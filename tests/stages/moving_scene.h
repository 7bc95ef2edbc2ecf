// A small scene in which everything moves that can: rigid, skinned, morphed, hidden and shining parts over a floor.
#pragma once
#include <filesystem>
#include <memory>
#include <span>

/// Compiles it, into a folder that lives as long as the object. One clip of two seconds: a box turns and travels, a strip of
/// two joints bends, a sheet with a morph target bulges, a lamp (a quad that shines) rises and changes its size, a quad and a
/// point light that are dark at rest begin to shine, a second box is hidden from
/// second 1 on, a spot light swings, a mirror ball slides.
class MovingScene
{
public:
    MovingScene();
    /// Another one. @param glb binary glTF
    explicit MovingScene(std::span<const uint8_t> glb);
    ~MovingScene();
    MovingScene(const MovingScene&) = delete;
    MovingScene& operator=(const MovingScene&) = delete;

    const std::filesystem::path& package() const { return package_; }
    /// A package of the scene as it is at that time, in which nothing moves. Each call replaces the one before.
    std::filesystem::path bakedAt(double seconds) const;

private:
    void compileSource() const;

    struct Folder;
    std::unique_ptr<Folder> folder_;
    std::filesystem::path source_, package_;
};
