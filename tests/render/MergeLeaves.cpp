#include "MergeLeaves.h"

#include "MixedScene.h"

#include <osg/AlphaFunc>
#include <osg/Billboard>
#include <osg/BlendEquation>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/LineWidth>
#include <osg/Material>
#include <osg/Point>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osg/Texture2D>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/RigTransformSoftware>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgText/Text>

namespace osgVolumizer {
namespace test {

namespace {

const glm::dvec4 COLOR(0.2, 0.9, 0.4, 0.5);
const float END = 32.0f;

osg::ref_ptr<osg::Geometry> square()
{
    return makeGeometry(quadMesh({glm::vec3(0), {END, 0, 0}, {END, END, 0}, {0, END, 0}}), COLOR);
}

void setBlend(osg::Node& node, GLenum source, GLenum destination)
{
    node.getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc(source, destination));
}

/// A grid of (n + 1)^2 points.
osg::ref_ptr<osg::Geometry> grid(int n)
{
    const osg::ref_ptr<osg::Geometry> geometry = square();
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x)
            points->push_back(osg::Vec3(END * x / n, END * y / n, 0.0f));
    geometry->setVertexArray(points);
    geometry->removePrimitiveSet(0);
    return geometry;
}

osg::ref_ptr<osg::Node> displayList()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->setUseVertexBufferObjects(false);
    g->setUseDisplayList(true);
    return g;
}

osg::ref_ptr<osg::Node> vertexBufferObject()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->setUseDisplayList(false);
    g->setUseVertexBufferObjects(true);
    return g;
}

osg::ref_ptr<osg::Node> vertexArrays()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->setUseDisplayList(false);
    g->setUseVertexBufferObjects(false);
    return g;
}

osg::ref_ptr<osg::Node> dynamicGeometry()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->setDataVariance(osg::Object::DYNAMIC);
    return g;
}

template <class Elements>
osg::ref_ptr<osg::Node> strips()
{
    const int n = 4;
    const osg::ref_ptr<osg::Geometry> g = grid(n);
    for (int y = 0; y < n; ++y) {
        osg::ref_ptr<Elements> strip = new Elements(y % 2 ? GL_QUAD_STRIP : GL_TRIANGLE_STRIP);
        for (int x = 0; x <= n; ++x)
            for (int up : {0, 1})
                strip->push_back(
                    static_cast<typename Elements::value_type>((y + up) * (n + 1) + x));
        g->addPrimitiveSet(strip);
    }
    return g;
}

osg::ref_ptr<osg::Node> arrayLengths()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (float x : {0.0f, 16.0f})
        for (const osg::Vec3 p : {osg::Vec3(0, 0, 0), {15, 0, 0}, {15, END, 0}, {0, END, 0}})
            points->push_back(p + osg::Vec3(x, 0, 0));
    g->setVertexArray(points);
    osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_POLYGON);
    lengths->push_back(4);
    lengths->push_back(4);
    g->setPrimitiveSet(0, lengths);
    return g;
}

osg::ref_ptr<osg::Node> doubles()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Vec3dArray> points = new osg::Vec3dArray;
    for (const osg::Vec3d p : {osg::Vec3d(0, 0, 0), {END, 0, 0}, {END, END, 0}, {0, END, 0}})
        points->push_back(p);
    g->setVertexArray(points);
    return g;
}

osg::ref_ptr<osg::Node> lines()
{
    const osg::ref_ptr<osg::Geometry> g = grid(10);
    osg::ref_ptr<osg::DrawElementsUShort> lines = new osg::DrawElementsUShort(GL_LINES);
    for (int i = 0; i <= 10; ++i)
        for (int k : {0, 10})
            lines->push_back(static_cast<GLushort>(i * 11 + k));
    g->addPrimitiveSet(lines);
    g->getOrCreateStateSet()->setAttributeAndModes(new osg::LineWidth(3.0f));
    return g;
}

osg::ref_ptr<osg::Node> points()
{
    const osg::ref_ptr<osg::Geometry> g = grid(12);
    g->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 169));
    g->getOrCreateStateSet()->setAttributeAndModes(new osg::Point(5.0f));
    return g;
}

osg::ref_ptr<osg::Node> perPrimitiveColors()
{
    const osg::ref_ptr<osg::Geometry> g = grid(1);
    g->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<osg::DrawElementsUByte> other = new osg::DrawElementsUByte(GL_TRIANGLES);
    for (unsigned char i : {1, 3, 2})
        other->push_back(i);
    g->addPrimitiveSet(other);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    colors->push_back({1, 0, 0, 0.5f});
    colors->push_back({0, 0, 1, 0.7f});
    g->setColorArray(colors, osg::Array::BIND_PER_PRIMITIVE_SET);
    return g;
}

osg::ref_ptr<osg::Node> vertexColors()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const osg::Vec4 c :
         {osg::Vec4(1, 0, 0, 0.2f), {0, 1, 0, 0.9f}, {0, 0, 1, 0.5f}, {1, 1, 0, 0.4f}})
        colors->push_back(c);
    g->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    return g;
}

osg::ref_ptr<osg::Node> textured()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 64; ++i)
        *(image->data() + i) = static_cast<unsigned char>(37 * i + 90);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    g->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (const osg::Vec2 c : {osg::Vec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
        coordinates->push_back(c);
    g->setTexCoordArray(0, coordinates);
    return g;
}

osg::ref_ptr<osg::Node> lit()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    for (const osg::Vec3 n :
         {osg::Vec3(0, 0, 1), {0.7f, 0, 0.7f}, {0, 0.7f, 0.7f}, {-0.7f, 0, 0.7f}})
        normals->push_back(n);
    g->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.9f, 0.5f, 0.1f, 0.5f));
    material->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.4f, 0.4f, 0.4f, 0.0f));
    material->setShininess(osg::Material::FRONT_AND_BACK, 20.0f);
    g->getOrCreateStateSet()->setAttributeAndModes(material);
    g->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    return g;
}

osg::ref_ptr<osg::Node> depthWritesOff()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->getOrCreateStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL, 0, 1, false));
    return g;
}

osg::ref_ptr<osg::Node> depthTestOff()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    return g;
}

osg::ref_ptr<osg::Node> depthRange()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->getOrCreateStateSet()->setAttributeAndModes(
        new osg::Depth(osg::Depth::LESS, 0.0, 0.75, false));
    return g;
}

// Seen from its back, with back faces culled in one half.
osg::ref_ptr<osg::Node> twoSided()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const bool turned : {false, true}) {
        Mesh mesh = quadMesh({glm::vec3(0), {END / 2, 0, 0}, {END / 2, END, 0}, {0, END, 0}});
        if (turned) {
            for (glm::vec3& p : mesh.points)
                p.x += END / 2;
            for (auto& t : mesh.triangles)
                std::swap(t[1], t[2]);
        }
        const osg::ref_ptr<osg::Geometry> g = makeGeometry(mesh, COLOR);
        g->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
        group->addChild(g);
    }
    return group;
}

osg::ref_ptr<osg::Node> alphaFunc()
{
    const osg::ref_ptr<osg::Node> g = vertexColors();
    g->getOrCreateStateSet()->setAttributeAndModes(
        new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.5f));
    return g;
}

glm::vec4 blendAdd(const glm::vec4& leaf, const glm::vec4& behind)
{
    return leaf + behind;
}

osg::ref_ptr<osg::Node> additive()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    setBlend(*g, GL_ONE, GL_ONE);
    return g;
}

// Filters what is behind: black on nothing, but for its alpha.
glm::vec4 blendMultiply(const glm::vec4& leaf, const glm::vec4& behind)
{
    return leaf.a > 0.0f ? glm::vec4(glm::vec3(COLOR) * glm::vec3(behind), leaf.a + behind.a)
                         : behind;
}

osg::ref_ptr<osg::Node> multiplicative()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    g->getOrCreateStateSet()->setAttributeAndModes(
        new osg::BlendFunc(GL_DST_COLOR, GL_ZERO, GL_ONE, GL_ONE));
    return g;
}

glm::vec4 blendMaximum(const glm::vec4& leaf, const glm::vec4& behind)
{
    return glm::max(leaf, behind);
}

osg::ref_ptr<osg::Node> maximum()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    setBlend(*g, GL_ONE, GL_ONE);
    g->getOrCreateStateSet()->setAttributeAndModes(
        new osg::BlendEquation(osg::BlendEquation::RGBA_MAX));
    return g;
}

/// A drawable of an application's own, that knows no functors.
class Immediate : public osg::Drawable
{
public:
    Immediate() { setUseDisplayList(false); }
    Immediate(const Immediate& o, const osg::CopyOp& op) : osg::Drawable(o, op) {}
    META_Object(test, Immediate) osg::BoundingBox computeBoundingBox() const override
    {
        return {0, 0, 0, END, END, 0};
    }
    void drawImplementation(osg::RenderInfo&) const override
    {
        glColor4f(0.2f, 0.9f, 0.4f, 0.5f);
        glBegin(GL_QUADS);
        glVertex3f(0, 0, 0);
        glVertex3f(END, 0, 0);
        glVertex3f(END, END, 0);
        glVertex3f(0, END, 0);
        glEnd();
    }
};

template <bool displayLists>
osg::ref_ptr<osg::Node> customDrawable()
{
    const osg::ref_ptr<Immediate> drawable = new Immediate;
    drawable->setStateSet(square()->getStateSet());
    drawable->setSupportsDisplayList(displayLists);
    drawable->setUseDisplayList(displayLists);
    return drawable;
}

osg::ref_ptr<osg::Node> drawCallback()
{
    struct Callback : osg::Drawable::DrawCallback
    {
        void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
        {
            drawable->drawImplementation(info);
        }
    };
    const osg::ref_ptr<osg::Geometry> g = square();
    g->setDrawCallback(new Callback);
    return g;
}

osg::ref_ptr<osg::Node> shape()
{
    osg::ref_ptr<osg::ShapeDrawable> box =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(16, 16, 0), 28, 28, 1e-3f));
    box->setColor(osg::Vec4(0.2f, 0.9f, 0.4f, 0.5f));
    box->setStateSet(square()->getStateSet());
    box->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
    return box;
}

// The bounds say where the shader puts the vertices.
struct WhereShaderMoves : osg::Drawable::ComputeBoundingBoxCallback
{
    osg::BoundingBox computeBound(const osg::Drawable&) const override
    {
        return {0, 0, -1e-3f, END, END, 1e-3f};
    }
};

osg::ref_ptr<osg::Node> displacedByShader()
{
    // Far away as an array of vertices.
    const osg::ref_ptr<osg::Geometry> g = makeGeometry(
        quadMesh({glm::vec3(0, 0, 40), {END, 0, 40}, {END, END, 40}, {0, END, 40}}), COLOR);
    g->setComputeBoundingBoxCallback(new WhereShaderMoves);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(
        uniform float offset;
        void main() { gl_FrontColor = gl_Color; gl_Position = gl_ModelViewProjectionMatrix * (gl_Vertex + vec4(0, 0, offset, 0)); })"));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT, "void main() { gl_FragColor = gl_Color; }"));
    g->getOrCreateStateSet()->setAttributeAndModes(program);
    g->getOrCreateStateSet()->addUniform(new osg::Uniform("offset", -40.0f));
    return g;
}

osg::ref_ptr<osg::Node> instanced()
{
    const osg::ref_ptr<osg::Geometry> g = makeGeometry(
        quadMesh({glm::vec3(0), {END / 2, 0, 0}, {END / 2, END, 0}, {0, END, 0}}), COLOR);
    g->setComputeBoundingBoxCallback(new WhereShaderMoves);
    g->setUseDisplayList(false);
    g->setUseVertexBufferObjects(true);
    g->getPrimitiveSet(0)->setNumInstances(2);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 150 compatibility
        out vec4 color;
        void main() { color = gl_Color; gl_Position = gl_ModelViewProjectionMatrix * (gl_Vertex + vec4(16.0 * gl_InstanceID, 0, 0, 0)); })"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 150 compatibility
        in vec4 color;
        void main() { gl_FragColor = color; })"));
    g->getOrCreateStateSet()->setAttributeAndModes(program);
    return g;
}

osg::ref_ptr<osg::Node> fragmentShader()
{
    const osg::ref_ptr<osg::Geometry> g = square();
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(fract(gl_FragCoord.xy * "
                                       "0.1), gl_FrontFacing ? 1.0 : 0.0, 0.5); }"));
    g->getOrCreateStateSet()->setAttributeAndModes(program);
    return g;
}

// The bone moves the square, far behind at rest, into the plane.
osg::ref_ptr<osg::Node> skinned()
{
    const osg::ref_ptr<osg::Geometry> source = makeGeometry(
        quadMesh({glm::vec3(0, 0, -8), {END, 0, -8}, {END, END, -8}, {0, END, -8}}), COLOR);
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setSourceGeometry(source);
    rig->copyFrom(*source);
    rig->setStateSet(source->getStateSet());
    rig->setDataVariance(osg::Object::DYNAMIC);
    rig->setUseDisplayList(false);
    osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences =
        new osgAnimation::VertexInfluenceMap;
    osgAnimation::VertexInfluence& influence = (*influences)["bone"];
    influence.setName("bone");
    for (unsigned i = 0; i < 4; ++i)
        influence.push_back(osgAnimation::VertexIndexWeight(i, 1.0f));
    rig->setInfluenceMap(influences);
    rig->setRigTransformImplementation(new osgAnimation::RigTransformSoftware);
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("bone");
    osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone("bone");
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedTranslateElement("translate", osg::Vec3(0, 0, 8)));
    bone->setUpdateCallback(update);
    skeleton->addChild(bone);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(rig);
    skeleton->addChild(geode);
    return skeleton;
}

osg::ref_ptr<osg::Node> text()
{
    osg::ref_ptr<osgText::Text> t = new osgText::Text;
    t->setFont("DejaVuSans-Bold.ttf");
    t->setPosition(osg::Vec3(1, 8, 0));
    t->setCharacterSize(16.0f);
    t->setColor(osg::Vec4(1.0f, 0.9f, 0.2f, 0.7f));
    t->setText("abc");
    t->getOrCreateStateSet()->merge(*square()->getStateSet());
    return t;
}

// Placed by their model-view matrices.
osg::ref_ptr<osg::Node> scaled()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (float x : {0.0f, 16.0f})
        group->addChild(MixedScene::placed(
            makeGeometry(quadMesh({glm::vec3(0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), COLOR),
            osg::Matrixd::scale(16, 32, 1) * osg::Matrixd::translate(x, 0, 0)));
    return group;
}

} // namespace

const std::vector<LeafKind>& leafKinds()
{
    static const std::vector<LeafKind> kinds = {
        {"DisplayList", displayList, blendOver},
        {"VertexBufferObject", vertexBufferObject, blendOver},
        {"VertexArrays", vertexArrays, blendOver},
        {"Dynamic", dynamicGeometry, blendOver},
        {"StripsOfBytes", strips<osg::DrawElementsUByte>, blendOver},
        {"StripsOfShorts", strips<osg::DrawElementsUShort>, blendOver},
        {"ArrayLengths", arrayLengths, blendOver},
        {"Doubles", doubles, blendOver},
        {"Lines", lines, blendOver},
        {"Points", points, blendOver},
        {"ColorsPerPrimitiveSet", perPrimitiveColors, blendOver},
        {"ColorsPerVertex", vertexColors, blendOver},
        {"Textured", textured, blendOver},
        {"Lit", lit, blendOver, true},
        {"DepthWritesOff", depthWritesOff, blendOver},
        {"DepthTestOff", depthTestOff, blendOver},
        {"DepthRange", depthRange, blendOver},
        {"TwoSided", twoSided, blendOver},
        {"AlphaFunc", alphaFunc, blendOver},
        {"Additive", additive, blendAdd},
        {"Multiplicative", multiplicative, blendMultiply},
        {"Maximum", maximum, blendMaximum},
        {"CustomDrawable", customDrawable<false>, blendOver},
        {"CustomDrawableInDisplayList", customDrawable<true>, blendOver},
        {"DrawCallback", drawCallback, blendOver},
        {"Shape", shape, blendOver},
        {"DisplacedByShader", displacedByShader, blendOver},
        {"Instanced", instanced, blendOver},
        {"FragmentShader", fragmentShader, blendOver},
        {"Skinned", skinned, blendOver},
        {"Text", text, blendOver},
        {"Scaled", scaled, blendOver}};
    return kinds;
}

} // namespace test
} // namespace osgVolumizer
