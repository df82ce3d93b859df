#include "TetraTextures.h"

#include "../../VolumeGeometry.h"
#include "../../core/geometry/TetraGraph.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgVolumizer {
namespace render {

namespace {

constexpr float NO_SCALAR = 3e38f;
constexpr GLenum RED_INTEGER = 0x8D94, R32UI = 0x8236;

template <class Value>
osg::ref_ptr<osg::TextureBuffer> bufferTexture(const std::vector<Value>& texels, GLenum format,
                                               GLenum type, GLenum internalFormat)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texels.size()), 1, 1, format, type, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(Value));
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer;
    texture->setImage(image);
    texture->setInternalFormat(static_cast<GLint>(internalFormat));
    texture->setUnRefImageDataAfterApply(false);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

osg::ref_ptr<osg::TextureBuffer> vectorTexture(const std::vector<glm::vec4>& texels)
{
    return bufferTexture(texels, GL_RGBA, GL_FLOAT, GL_RGBA32F_ARB);
}

template <class Get>
osg::ref_ptr<osg::TextureBuffer> vertexTexture(const core::VertexArray& vertices, const Get& get)
{
    std::vector<glm::vec4> texels(vertices.size());
    for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = glm::vec4(get(i));
    return vectorTexture(texels);
}

glm::dvec4 colorOf(const core::VertexArray& vertices, std::size_t i)
{
    const core::VertexFormat& format = vertices.format();
    const double* c = vertices.record(i) + format.colorOffset();
    return {c[0], c[1], c[2], format.colorSize == 4 ? c[3] : 1.0};
}

} // namespace

std::vector<osg::TextureBuffer*> TetraTextures::all() const
{
    std::vector<osg::TextureBuffer*> result;
    for (const auto& texture : {graph, positions, boxes, places, colors, fields, scalars})
        if (texture) result.push_back(texture.get());
    return result;
}

std::size_t TetraTextures::bytes() const
{
    std::size_t sum = 0;
    for (const osg::TextureBuffer* texture : all())
        sum += texture->getImage()->getTotalSizeInBytes();
    return sum;
}

std::shared_ptr<const TetraTextures> makeTetraTextures(const core::TetraSet& set, bool places)
{
    // Image counts the bits of a row in an int.
    constexpr std::size_t MOST_TEXELS = std::size_t(1) << 24, MOST_WORDS = std::size_t(1) << 26;
    const std::size_t fields = static_cast<std::size_t>(set.vertices.format().userSize);
    if (set.vertices.size() >= MOST_TEXELS || set.vertices.size() * fields >= MOST_WORDS ||
        set.tetraCount() >= MOST_WORDS)
        return nullptr;
    core::TetraGraph graph = core::makeTetraGraph(set);
    if (graph.words.size() >= MOST_WORDS || graph.boxes.size() >= MOST_TEXELS) return nullptr;
    auto result = std::make_shared<TetraTextures>();
    result->cellCount = graph.cellCount;
    result->facesBegin = static_cast<int>(graph.facesBegin);
    result->vertexCount = set.vertices.size();
    result->faceCount = static_cast<int>(graph.faceCount);
    result->leafCount = static_cast<int>(graph.leafCount);
    result->leafFaces = static_cast<int>(graph.leafFaces);
    const glm::dvec3 size = set.bounds().size();
    result->size = static_cast<float>(std::max({size.x, size.y, size.z}));
    std::vector<glm::vec4> boxes;
    for (const glm::vec3& corner : graph.boxes)
        boxes.emplace_back(corner, 0.0f);
    result->boxes = vectorTexture(boxes);
    result->oddities = graph.oddities();
    result->isOdd = graph.isOdd();
    result->graph = bufferTexture(graph.words, RED_INTEGER, GL_UNSIGNED_INT, R32UI);
    result->numbers = std::make_shared<const std::vector<std::uint32_t>>(std::move(graph.numbers));
    const core::VertexArray& vertices = set.vertices;
    result->positions = vertexTexture(
        vertices, [&](std::size_t i) { return glm::dvec4(vertices.position(i), 1.0); });
    if (places && vertices.format().voxelCoordinateSize == 3)
        result->places = vertexTexture(
            vertices, [&](std::size_t i) { return glm::dvec4(vertices.voxelCoordinate(i), 1.0); });
    if (vertices.format().colorSize > 0)
        result->colors =
            vertexTexture(vertices, [&](std::size_t i) { return colorOf(vertices, i); });
    if (vertices.format().userSize > 0) {
        std::vector<float> values;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double* user = vertices.record(i) + vertices.format().userOffset();
            values.insert(values.end(), user, user + vertices.format().userSize);
        }
        result->fields = bufferTexture(values, GL_RED, GL_FLOAT, GL_R32F);
    }
    return result;
}

std::shared_ptr<const TetraTextures> withScalars(const TetraTextures& textures,
                                                 const VolumeGeometry& geometry)
{
    auto result = std::make_shared<TetraTextures>(textures);
    const VolumeGeometry::ScalarField field = geometry.getScalarField();
    const VolumeGeometry::ScalarsPtr scalars =
        field.values ? field.values : std::make_shared<const std::vector<float>>();
    const osg::Vec2d range = field.range;
    const bool ofCells = field.binding == VolumeGeometry::PER_TETRAHEDRON;
    result->scalarCount = field.count;
    result->ofCells = ofCells;
    result->range = range;
    const double perUnit = 1.0 / (range.y() - range.x());
    std::vector<float> fractions(ofCells ? textures.numbers->size() : textures.vertexCount);
    for (std::size_t i = 0; i < fractions.size(); ++i) {
        const std::size_t from = ofCells ? (*textures.numbers)[i] : i;
        const double value = from < scalars->size() ? (*scalars)[from] : NAN;
        fractions[i] =
            std::isfinite(value)
                ? static_cast<float>(std::clamp((value - range.x()) * perUnit, -1e29, 1e29))
                : NO_SCALAR;
    }
    result->scalars = bufferTexture(fractions, GL_RED, GL_FLOAT, GL_R32F);
    return result;
}

} // namespace render
} // namespace osgVolumizer
