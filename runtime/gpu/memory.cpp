#include "runtime/gpu/memory.h"

Memory::~Memory()
{
    if (!device_)
        return;
    vkFreeMemory(device_, memory_, nullptr);
    *total_ -= size_;
}

Buffer::~Buffer()
{
    if (!device_)
        return;
    vkDestroyBufferView(device_, texels_, nullptr);
    vkDestroyBuffer(device_, buffer_, nullptr);
}

void Buffer::swap(Buffer& other)
{
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(texels_, other.texels_);
    std::swap(memory_, other.memory_);
    std::swap(offset_, other.offset_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    std::swap(name_, other.name_);
}

Image::~Image()
{
    if (!device_)
        return;
    vkDestroyImageView(device_, view_, nullptr);
    vkDestroyImage(device_, image_, nullptr);
}

void Image::swap(Image& other)
{
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(view_, other.view_);
    std::swap(memory_, other.memory_);
}
