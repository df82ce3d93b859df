// A mirror under a scene: a nested camera renders the reflected scene to a texture, volumes and
// all. Nothing here knows of volumes; they are merged with other translucent geometry once more for
// that view.
//
//   osgvolumizermirror SCENE              in a window
//   osgvolumizermirror SCENE PICTURE.png  without one

#include <support/PictureFile.h>
#include <support/ReadScene.h>
#include <support/SceneRenderer.h>

#include <osg/FrontFace>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2D>
#include <osgViewer/Viewer>

#include <cstdio>

namespace {

constexpr int MIRROR_SIZE = 1024; // pixels of the texture

/// Renders a scene reflected in the plane z = `height` of its own frame. The camera is relative, so
/// that it sees the scene from wherever the camera above it does, in any number of views.
osg::ref_ptr<osg::Camera> makeReflection(osg::Node* scene, double height, osg::Texture2D* texture)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(osg::Camera::PRE_RENDER);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->setReferenceFrame(osg::Transform::RELATIVE_RF);
    camera->setTransformOrder(osg::Camera::PRE_MULTIPLY);
    camera->setViewMatrix(osg::Matrixd::scale(1.0, 1.0, -1.0) *
                          osg::Matrixd::translate(0.0, 0.0, 2.0 * height));
    camera->setViewport(0, 0, MIRROR_SIZE, MIRROR_SIZE);
    camera->setClearColor(osg::Vec4(0.10f, 0.11f, 0.13f, 1.0f));
    camera->attach(osg::Camera::COLOR_BUFFER, texture);
    // What is reflected turns the other way round.
    camera->getOrCreateStateSet()->setAttribute(new osg::FrontFace(osg::FrontFace::CLOCKWISE));
    camera->addChild(scene);
    return camera;
}

/// A square that shows the texture where the view of it has the same pixel.
osg::ref_ptr<osg::Geometry> makeMirror(const osg::BoundingSphere& bound, double height,
                                       osg::Texture2D* texture)
{
    const osg::Vec3 center(bound.center().x(), bound.center().y(), height);
    const float half = 2.8f * bound.radius();
    osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
        center - osg::Vec3(half, half, 0.0f), osg::Vec3(2.0f * half, 0.0f, 0.0f),
        osg::Vec3(0.0f, 2.0f * half, 0.0f));
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                       "varying vec4 clip;\n"
                                       "void main() {\n"
                                       "    clip = gl_ModelViewProjectionMatrix * gl_Vertex;\n"
                                       "    gl_Position = clip;\n"
                                       "}\n"));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT,
                        "uniform sampler2D reflection;\n"
                        "varying vec4 clip;\n"
                        "void main() {\n"
                        "    vec3 seen = texture2D(reflection, 0.5 + 0.5 * clip.xy / clip.w).rgb;\n"
                        "    gl_FragColor = vec4(0.85 * seen, 1.0);\n"
                        "}\n"));
    osg::StateSet& state = *square->getOrCreateStateSet();
    state.setAttributeAndModes(program);
    state.setTextureAttributeAndModes(0, texture);
    state.addUniform(new osg::Uniform("reflection", 0));
    return square;
}

osg::ref_ptr<osg::Group> withMirror(osg::Node* scene)
{
    const osg::BoundingSphere& bound = scene->getBound();
    const double height = bound.center().z() - 0.62 * bound.radius();
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(MIRROR_SIZE, MIRROR_SIZE);
    texture->setInternalFormat(GL_RGBA8);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(makeReflection(scene, height, texture));
    root->addChild(makeMirror(bound, height, texture));
    root->addChild(scene);
    return root;
}

int drawPicture(osg::Node* root, const osg::BoundingSphere& bound, const char* file)
{
    using namespace osgVolumizer::support;
    RenderOptions options;
    const osg::Vec3d center = bound.center() - osg::Vec3d(0.0, 0.0, 0.6 * bound.radius());
    options.size(640, 480).perspective(30.0).lookAt(
        center + osg::Vec3d(-1.6, -5.6, 1.7) * bound.radius(), center, osg::Vec3d(0.0, 0.0, 1.0));
    options.background = osg::Vec4(0.10f, 0.11f, 0.13f, 1.0f);
    options.light = true;
    options.frames = 2;
    const osgVolumizer::Status status = writePicture(renderScene(root, options), file);
    if (!status) std::fprintf(stderr, "%s\n", status.text.c_str());
    return status ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2 || argc > 3) {
        std::fprintf(stderr, "usage: osgvolumizermirror SCENE [PICTURE.png]\n");
        return 2;
    }
    const auto read = osgVolumizer::support::readScene(argv[1]);
    if (!read.ok()) {
        std::fprintf(stderr, "osgvolumizermirror: %s\n", read.status.text.c_str());
        return 1;
    }
    const osg::ref_ptr<osg::Node>& scene = *read;
    const osg::ref_ptr<osg::Group> root = withMirror(scene);
    if (argc == 3) return drawPicture(root, scene->getBound(), argv[2]);
    osgViewer::Viewer viewer;
    viewer.setSceneData(root);
    return viewer.run();
}
