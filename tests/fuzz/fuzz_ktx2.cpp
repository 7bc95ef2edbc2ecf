// Reading any bytes as a KTX2 texture gives an error or as many texels as the header states.
#include "compiler/ktx2.h"
#include "format/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    const auto accept = [](uint32_t width, uint32_t height) -> Status
    {
        if (width > 512 || height > 512)
            return Error{ExitCode::kUnsupported, "it is large"};
        return Success{};
    };
    const Result<Ktx2Image> image = decodeKtx2(std::as_bytes(std::span(data, size)), accept);
    check(image || !image.error().message.empty(), "an error without a sentence");
    if (image)
        check(image->texels.size() == size_t(4) * image->width * image->height &&
                  (image->deep.empty() || image->deep.size() == image->texels.size()),
              "{} texels", image->texels.size());
    return 0;
}
