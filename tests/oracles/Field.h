#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace oracle {

/// A scalar function of space with its gradient, in a frame of its own (the field frame).
class Field
{
public:
    virtual ~Field() = default;
    virtual double value(const glm::dvec3& p) const = 0;
    virtual glm::dvec3 gradient(const glm::dvec3& p) const = 0;
    /// Appends the t in (t0, t1) where g(value(origin + t direction)) may not be smooth, for a
    /// function g that is smooth but for the given values, which ascend. Here: a plain division
    /// into 64 pieces, from which an adaptive integrator finds the rest.
    virtual void appendBreaks(const glm::dvec3& origin, const glm::dvec3& direction, double t0,
                              double t1, const std::vector<double>& values,
                              std::vector<double>& breaks) const;
};

class ConstantField : public Field
{
public:
    explicit ConstantField(double v) : _value(v) {}
    double value(const glm::dvec3&) const override { return _value; }
    glm::dvec3 gradient(const glm::dvec3&) const override { return glm::dvec3(0.0); }

private:
    double _value;
};

/// offset + dot(slope, p).
class RampField : public Field
{
public:
    RampField(const glm::dvec3& slope, double offset) : _slope(slope), _offset(offset) {}
    double value(const glm::dvec3& p) const override;
    glm::dvec3 gradient(const glm::dvec3&) const override { return _slope; }
    /// Where it takes the values.
    void appendBreaks(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1,
                      const std::vector<double>& values,
                      std::vector<double>& breaks) const override;

private:
    glm::dvec3 _slope;
    double _offset;
};

/// scale * x * y * z: reproduced exactly by trilinear interpolation of its samples.
class ProductField : public Field
{
public:
    explicit ProductField(double scale = 1.0) : _scale(scale) {}
    double value(const glm::dvec3& p) const override { return _scale * p.x * p.y * p.z; }
    glm::dvec3 gradient(const glm::dvec3& p) const override;

private:
    double _scale;
};

/// amplitude * exp(-|p - center|^2 / (2 sigma^2)).
class GaussianField : public Field
{
public:
    GaussianField(const glm::dvec3& center, double sigma, double amplitude = 1.0)
        : _center(center), _sigma(sigma), _amplitude(amplitude)
    {
    }
    double value(const glm::dvec3& p) const override;
    glm::dvec3 gradient(const glm::dvec3& p) const override;

private:
    glm::dvec3 _center;
    double _sigma;
    double _amplitude;
};

/// The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume
/// rendering", Visualization 1994, on [-1, 1]^3, with values in [0, 1].
class MarschnerLobbField : public Field
{
public:
    explicit MarschnerLobbField(double frequency = 6.0, double alpha = 0.25)
        : _frequency(frequency), _alpha(alpha)
    {
    }
    double value(const glm::dvec3& p) const override;
    glm::dvec3 gradient(const glm::dvec3& p) const override;

private:
    double _frequency;
    double _alpha;
};

} // namespace oracle
} // namespace osgVolumizer
