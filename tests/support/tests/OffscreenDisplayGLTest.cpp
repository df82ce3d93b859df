#include <support/GLTest.h>
#include <support/Shapes.h>

#include <algorithm>

namespace OffscreenDisplayGLTest {

using namespace osgVolumizer::support;
using osgVolumizer::ErrorCode;

namespace {

constexpr const char* VARIABLE = "OSGVOLUMIZER_EGL_DEVICE";

// The environment variable has a value, or none, until this ends.
class Environment
{
public:
    explicit Environment(const char* value)
    {
        if (const char* old = std::getenv(VARIABLE)) _old = old;
        set(value);
    }
    ~Environment() { set(_old ? _old->c_str() : nullptr); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    static void set(const char* value) { value ? setenv(VARIABLE, value, 1) : unsetenv(VARIABLE); }

    std::optional<std::string> _old;
};

class OffscreenDisplayGLTest : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        for (int i = 0; i < OffscreenDisplay::deviceCount(); ++i)
            if (OffscreenDisplay::open(i).ok()) drawing.push_back(i);
        if (drawing.empty() && !IsSkipped()) FAIL() << "No device of EGL opens.";
    }

    std::vector<int> drawing; // numbers of the devices that open
};

RenderOptions frontal()
{
    return RenderOptions().size(32, 32).orthographic(1.0).lookAt({0, -5, 0}, {0, 0, 0}, {0, 0, 1});
}

osg::ref_ptr<osg::Geometry> makeSquare()
{
    return makeQuad(
        {osg::Vec3(-0.5f, 0, -0.5f), {0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}, {-0.5f, 0, 0.5f}},
        osg::Vec4(0.25f, 0.5f, 0.75f, 1.0f));
}

} // namespace

TEST_F(OffscreenDisplayGLTest, DevicesDrawAndSayWhichTheyAre)
{
    const FloatImage expected = renderScene(makeSquare(), frontal());
    ASSERT_EQ(coveredPixels(expected).count(), 256u);
    for (const int device : drawing) {
        RenderOptions options = frontal();
        options.device = device;
        SceneRenderer renderer(makeSquare(), options);
        EXPECT_EQ(renderer.render().pixels, expected.pixels) << device;
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_EQ(renderer.device().number, device);
        EXPECT_EQ(renderer.device().platform, "EGL_EXT_platform_device");
        EXPECT_FALSE(renderer.device().renderer.empty());
    }
}

TEST_F(OffscreenDisplayGLTest, DisplaysStayOpenWhileContextsComeAndGo)
{
    auto first = OffscreenContext::create();
    ASSERT_TRUE(first.ok()) << first.status.text;
    for (int i = 0; i < 3; ++i) {
        auto second = OffscreenContext::create(OffscreenContext::CORE, nullptr, drawing.front());
        auto third =
            OffscreenContext::create(OffscreenContext::COMPATIBILITY, nullptr, drawing.front());
        ASSERT_TRUE(second.ok() && third.ok()) << second.status.text << third.status.text;
        EXPECT_TRUE(second.value->makeCurrent());
        EXPECT_TRUE(third.value->makeCurrent());
        EXPECT_FALSE(second.value->isCurrent());
        second.value.reset();
        EXPECT_TRUE(third.value->isCurrent());
        EXPECT_TRUE(first.value->makeCurrent());
    }
    EXPECT_TRUE(first.value->isCurrent());
}

TEST_F(OffscreenDisplayGLTest, ContextsThatShareAreOnOneDisplay)
{
    auto first =
        OffscreenContext::create(OffscreenContext::COMPATIBILITY, nullptr, drawing.front());
    ASSERT_TRUE(first.ok()) << first.status.text;
    auto second = OffscreenContext::create(OffscreenContext::COMPATIBILITY, first.value.get());
    ASSERT_TRUE(second.ok()) << second.status.text;
    EXPECT_EQ(&second.value->display(), &first.value->display());
}

TEST_F(OffscreenDisplayGLTest, EnvironmentChooses)
{
    const Environment named(std::to_string(drawing.back()).c_str());
    const auto context = OffscreenContext::create();
    ASSERT_TRUE(context.ok()) << context.status.text;
    EXPECT_EQ(context.value->display().device(), drawing.back());
    for (const char* none : {"999", "-1", "0x0", "1.0", "first", " 0"}) {
        const Environment wrong(none);
        const auto refused = OffscreenContext::create();
        EXPECT_FALSE(refused.ok());
        EXPECT_NE(refused.status.text.find(std::string("'") + none + "'"), std::string::npos)
            << refused.status.text;
        SceneRenderer renderer(makeSquare(), frontal());
        EXPECT_EQ(renderer.status().text, refused.status.text);
        EXPECT_TRUE(renderer.render().empty());
    }
}

TEST_F(OffscreenDisplayGLTest, WithoutAChoiceTheFirstThatOpens)
{
    const Environment none(nullptr);
    const auto display = OffscreenDisplay::openDefault();
    ASSERT_TRUE(display.ok()) << display.status.text;
    const auto surfaceless = OffscreenDisplay::open(OffscreenDisplay::SURFACELESS);
    EXPECT_EQ((*display)->device(),
              surfaceless.ok() ? OffscreenDisplay::SURFACELESS : drawing.front());

    const int missing = OffscreenDisplay::deviceCount();
    const auto other = OffscreenDisplay::openFirst({missing, drawing.back(), drawing.front()});
    ASSERT_TRUE(other.ok()) << other.status.text;
    EXPECT_EQ((*other)->device(), drawing.back());
    const auto neither = OffscreenDisplay::openFirst({missing, missing + 1});
    EXPECT_FALSE(neither.ok());
    EXPECT_EQ(std::count(neither.status.text.begin(), neither.status.text.end(), '.'), 1);
    for (const int device : {missing, missing + 1})
        EXPECT_NE(neither.status.text.find("'" + std::to_string(device) + "'"), std::string::npos)
            << neither.status.text;
}

TEST_F(OffscreenDisplayGLTest, NumbersOfDevices)
{
    const int count = OffscreenDisplay::deviceCount();
    const auto last = OffscreenDisplay::parseDevice(std::to_string(count - 1));
    EXPECT_TRUE(last.ok() && *last == count - 1) << last.status.text;
    for (const std::string& text : {std::to_string(count), std::string("99999999999999999999")})
        EXPECT_EQ(OffscreenDisplay::parseDevice(text).status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    for (const char* text : {"", "-1", "one", "0 ", "0.5"})
        EXPECT_EQ(OffscreenDisplay::parseDevice(text).status.code, ErrorCode::VALUE_INVALID);
}

} // namespace OffscreenDisplayGLTest
