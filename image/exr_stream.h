// Bytes in memory as OpenEXR reads a file.
#pragma once
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfIO.h>

#include <cstddef>
#include <cstring>
#include <span>

class ExrStream : public Imf::IStream
{
public:
    explicit ExrStream(std::span<const std::byte> bytes) : IStream("the EXR image"), bytes_(bytes) {}

    bool read(char target[], int count) override
    {
        if (count < 0 || at_ > bytes_.size() || uint64_t(count) > bytes_.size() - at_)
            throw IEX_NAMESPACE::InputExc("the file is cut off");
        if (count > 0)
            std::memcpy(target, bytes_.data() + at_, size_t(count));
        at_ += uint64_t(count);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override { at_ = position; }

private:
    std::span<const std::byte> bytes_;
    uint64_t at_ = 0;
};
