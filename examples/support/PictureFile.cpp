#include "PictureFile.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace support {
namespace {

template <class T>
Status write(const FloatImage& image, const std::string& fileName, OIIO::ImageSpec spec,
             const std::vector<T>& values)
{
    auto output = OIIO::ImageOutput::create(fileName);
    if (!output)
        return Status(ErrorCode::NOT_SUPPORTED,
                      "Cannot write '" + fileName + "': " + OIIO::geterror() + ".");
    const OIIO::stride_t row = OIIO::stride_t(sizeof(T)) * spec.nchannels * image.width;
    // Picture files start at the top, ours at the bottom.
    const T* top = values.data() + std::size_t(image.height - 1) * image.width * spec.nchannels;
    if (!output->open(fileName, spec) ||
        !output->write_image(spec.format, top, OIIO::AutoStride, -row) || !output->close())
        return Status(ErrorCode::FILE_UNREADABLE,
                      "Cannot write '" + fileName + "': " + output->geterror() + ".");
    return Status();
}

unsigned char toByte(float value)
{
    return static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

} // namespace

Status writeFloatPicture(const FloatImage& image, const std::string& fileName)
{
    if (image.empty()) return Status(ErrorCode::SIZE_MISMATCH, "There is no picture to write.");
    OIIO::ImageSpec spec(image.width, image.height, 4, OIIO::TypeDesc::FLOAT);
    spec.attribute("oiio:ColorSpace", "Linear");
    std::vector<float> values;
    values.reserve(image.pixels.size() * 4);
    for (const glm::vec4& p : image.pixels)
        values.insert(values.end(), {p.r, p.g, p.b, p.a});
    return write(image, fileName, spec, values);
}

Status writeDisplayPicture(const FloatImage& image, const std::string& fileName)
{
    if (image.empty()) return Status(ErrorCode::SIZE_MISMATCH, "There is no picture to write.");
    OIIO::ImageSpec spec(image.width, image.height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    std::vector<unsigned char> values;
    values.reserve(image.pixels.size() * 4);
    for (const glm::vec4& p : image.pixels) {
        const float undo = p.a > 0.0f ? 1.0f / std::min(p.a, 1.0f) : 1.0f;
        for (int c = 0; c < 3; ++c)
            values.push_back(toByte(p[c] * undo));
        values.push_back(toByte(p.a));
    }
    return write(image, fileName, spec, values);
}

Status writePicture(const FloatImage& image, const std::string& fileName)
{
    const std::string extension = fileName.substr(std::min(fileName.rfind('.'), fileName.size()));
    if (extension == ".png" || extension == ".jpg") return writeDisplayPicture(image, fileName);
    return writeFloatPicture(image, fileName);
}

Result<FloatImage> readFloatPicture(const std::string& fileName)
{
    auto input = OIIO::ImageInput::open(fileName);
    if (!input)
        return Status(ErrorCode::FILE_UNREADABLE,
                      "Cannot read '" + fileName + "': " + OIIO::geterror() + ".");
    const OIIO::ImageSpec& spec = input->spec();
    FloatImage image(spec.width, spec.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    const int channels = std::min(spec.nchannels, 4);
    const OIIO::stride_t row = OIIO::stride_t(sizeof(glm::vec4)) * spec.width;
    glm::vec4* top = image.pixels.data() + std::size_t(spec.height - 1) * spec.width;
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, top, sizeof(glm::vec4), -row))
        return Status(ErrorCode::FILE_UNREADABLE,
                      "Cannot read '" + fileName + "': " + input->geterror() + ".");
    return image;
}

} // namespace support
} // namespace osgVolumizer
