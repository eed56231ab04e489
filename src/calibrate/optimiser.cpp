// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/optimiser.h"

#include "core/file.h"

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include <boost/archive/text_iarchive.hpp>
#include <boost/archive/text_oarchive.hpp>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace
{

// The C function as pagmo's problem.
struct unit_problem {
    cp_optimiser_function function = nullptr;
    void *context = nullptr;
    size_t dimension = 0;

    pagmo::vector_double fitness(const pagmo::vector_double &point) const
    {
        return {function(context, point.data(), point.size())};
    }

    std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const
    {
        return {pagmo::vector_double(dimension, 0.0), pagmo::vector_double(dimension, 1.0)};
    }

    // Function and context belong to the process; files hold population and algorithm only.
    template <typename Archive>
    void serialize(Archive &archive, unsigned)
    {
        archive &dimension;
    }
};

// One generation a call, ten of cmaes; cmaes and sade keep their adaptation between calls. (With
// one generation a call pagmo's cmaes was seen to stand still.)
pagmo::algorithm make_algorithm(const std::string &name, unsigned seed)
{
    if (name == "de")
        return pagmo::algorithm(pagmo::de(1u, 0.7, 0.9, 2u, 0.0, 0.0, seed));
    if (name == "sade")
        return pagmo::algorithm(pagmo::sade(1u, 2u, 1u, 0.0, 0.0, true, seed));
    if (name == "cmaes")
        return pagmo::algorithm(
            pagmo::cmaes(10u, -1.0, -1.0, -1.0, -1.0, 0.3, 0.0, 0.0, true, true, seed));
    throw std::invalid_argument("algorithm must be de, sade or cmaes, found '" + name + "'");
}

} // namespace

struct cp_optimiser {
    pagmo::algorithm algorithm;
    pagmo::population population;
    size_t generation = 0;
    pagmo::vector_double best_point; // of all generations
    double best_value = std::numeric_limits<double>::infinity();

    void remember_best()
    {
        const auto index = population.best_idx();
        if (population.get_f()[index][0] < best_value) {
            best_value = population.get_f()[index][0];
            best_point = population.get_x()[index];
        }
    }
};

// Run body; any exception becomes a status.
template <typename Body>
static cp_status guarded(cp_error *error, Body body)
{
    try {
        return body();
    } catch (const std::invalid_argument &trouble) {
        return cp_fail(error, CP_BAD_INPUT, "%s", trouble.what());
    } catch (const std::exception &trouble) {
        return cp_fail(error, CP_RUN_FAILED, "optimiser: %s", trouble.what());
    } catch (...) {
        return cp_fail(error, CP_RUN_FAILED, "optimiser: unknown failure");
    }
}

static pagmo::problem make_problem(const cp_optimiser_settings *settings)
{
    return pagmo::problem(unit_problem{settings->function, settings->context, settings->dimension});
}

cp_status cp_optimiser_create(const cp_optimiser_settings *settings, cp_optimiser **optimiser,
                              cp_error *error)
{
    return guarded(error, [&] {
        if (settings->population < 8)
            return cp_fail(error, CP_BAD_INPUT, "population must be at least 8, found %zu",
                           settings->population);
        pagmo::algorithm algorithm = make_algorithm(settings->algorithm, settings->seed);
        size_t random = settings->population - (settings->start != nullptr ? 1 : 0);
        pagmo::population population(make_problem(settings), random, settings->seed);
        if (settings->start != nullptr)
            population.push_back(
                pagmo::vector_double(settings->start, settings->start + settings->dimension));
        *optimiser = new cp_optimiser{std::move(algorithm), std::move(population), 0, {}};
        (*optimiser)->remember_best();
        return CP_OK;
    });
}

cp_status cp_optimiser_restore(const cp_optimiser_settings *settings, const char *path,
                               cp_optimiser **optimiser, cp_error *error)
{
    return guarded(error, [&] {
        std::ifstream file(path);
        if (!file)
            return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read", path);
        boost::archive::text_iarchive archive(file);
        std::string name;
        pagmo::algorithm algorithm;
        std::vector<pagmo::vector_double> points, values;
        size_t generation = 0;
        pagmo::vector_double best_point;
        double best_value = 0.0;
        archive >> name >> generation >> algorithm >> points >> values >> best_point >> best_value;
        if (name != settings->algorithm || points.size() != settings->population ||
            points.empty() || points[0].size() != settings->dimension)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s: was made with other settings (algorithm, population or unknowns); "
                           "remove it to start anew",
                           path);
        pagmo::population population(make_problem(settings), 0u, settings->seed);
        for (size_t k = 0; k < points.size(); k++)
            population.push_back(points[k], values[k]);
        *optimiser = new cp_optimiser{std::move(algorithm), std::move(population), generation,
                                      best_point, best_value};
        return CP_OK;
    });
}

void cp_optimiser_destroy(cp_optimiser *optimiser)
{
    delete optimiser;
}

cp_status cp_optimiser_evolve(cp_optimiser *optimiser, cp_error *error)
{
    return guarded(error, [&] {
        optimiser->population = optimiser->algorithm.evolve(optimiser->population);
        optimiser->generation++;
        optimiser->remember_best();
        return CP_OK;
    });
}

size_t cp_optimiser_generation(const cp_optimiser *optimiser)
{
    return optimiser->generation;
}

double cp_optimiser_best(const cp_optimiser *optimiser, double *point)
{
    for (size_t k = 0; point != nullptr && k < optimiser->best_point.size(); k++)
        point[k] = optimiser->best_point[k];
    return optimiser->best_value;
}

cp_status cp_optimiser_save(const cp_optimiser *optimiser, const char *path, cp_error *error)
{
    return guarded(error, [&] {
        std::ostringstream text;
        boost::archive::text_oarchive archive(text);
        const std::string name = optimiser->algorithm.is<pagmo::de>()     ? "de"
                                 : optimiser->algorithm.is<pagmo::sade>() ? "sade"
                                                                          : "cmaes";
        const std::vector<pagmo::vector_double> points = optimiser->population.get_x();
        const std::vector<pagmo::vector_double> values = optimiser->population.get_f();
        archive << name << optimiser->generation << optimiser->algorithm << points << values
                << optimiser->best_point << optimiser->best_value;
        const std::string content = text.str();
        return cp_file_write(path, content.data(), content.size(), error);
    });
}
