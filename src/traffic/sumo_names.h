/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_NAMES_H
#define TRAFFIC_SUMO_NAMES_H

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

/* (C++, inside the bridge only.) SUMO's ids as the numbers that the bridge gives out. */

// Names numbered in the order they are first seen.
class Names
{
  public:
    uint32_t number(const std::string &name)
    {
        auto [entry, is_new] = numbers_.try_emplace(name, static_cast<uint32_t>(names_.size()));
        if (is_new)
            names_.push_back(&entry->first); // keys of an unordered_map stay where they are
        return entry->second;
    }
    size_t size() const
    {
        return names_.size();
    }
    const std::string *name(uint32_t number) const
    {
        return number < names_.size() ? names_[number] : nullptr;
    }
    const char *text(uint32_t number) const
    {
        return number < names_.size() ? names_[number]->c_str() : "";
    }

  private:
    std::unordered_map<std::string, uint32_t> numbers_;
    std::vector<const std::string *> names_;
};

// Vehicles by number and id. Numbers and texts are for good: contacts name vehicles that have long
// gone. The way from the id to the number, which takes most room, is kept only while SUMO has it.
class VehicleNames
{
  public:
    struct Entry {
        uint32_t number;
        const std::string *id; // until it is forgotten
    };
    Entry find(const std::string &id)
    {
        auto [entry, is_new] = numbers_.try_emplace(id, static_cast<uint32_t>(texts_.size()));
        if (is_new)
            texts_.push_back(keep(id));
        return {entry->second, &entry->first}; // keys of an unordered_map stay where they are
    }
    bool has(uint32_t vehicle) const
    {
        return vehicle < texts_.size();
    }
    const char *text(uint32_t vehicle) const
    {
        return has(vehicle) ? &blocks_[texts_[vehicle] / BLOCK][texts_[vehicle] % BLOCK] : "";
    }
    void forget_id(const std::string &id)
    {
        numbers_.erase(id);
    }

  private:
    // A copy that stays where it is: number of its block times BLOCK, plus its place there. A
    // longer one has a block of its own.
    uint32_t keep(const std::string &id)
    {
        const size_t size = id.size() + 1;
        if (blocks_.empty() || used_ + size > BLOCK) {
            blocks_.push_back(std::make_unique<char[]>(std::max<size_t>(size, BLOCK)));
            used_ = 0;
        }
        const uint32_t place = static_cast<uint32_t>((blocks_.size() - 1) * BLOCK + used_);
        std::copy_n(id.c_str(), size, &blocks_.back()[used_]);
        used_ += size;
        return place;
    }

    static constexpr uint32_t BLOCK = 16384; // 4 GB of names in all
    std::unordered_map<std::string, uint32_t> numbers_;
    std::vector<uint32_t> texts_; // where it is kept
    std::vector<std::unique_ptr<char[]>> blocks_;
    size_t used_ = 0; // of the last block
};

#endif
