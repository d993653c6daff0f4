#include "reproduce/popov_values.h"

#include <limits>

namespace boxwood::program::reproduce {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr PopovFullRow kGeometric[] = {
    {"BUNNY", "C-BVH", {kNone, 66.6, 32.5, 24.7, 5.2, 0.7, 4.4, 13.0, 11.0}},
    {"BUNNY", "GP-BVH K_R=2^6", {kNone, 68.1, 33.7, 26.6, 4.7, 0.7, 4.2, 12.8, 10.4}},
    {"SPONZA", "C-BVH", {kNone, 142.6, 68.3, 46.7, 14.4, 0.4, 1.4, 8.1, 4.8}},
    {"SPONZA", "GP-BVH K_R=2^6", {kNone, 167.1, 85.5, 54.6, 20.6, 0.3, 0.9, 7.7, 3.6}},
    {"SPONZA", "GP-BVH K_R=2^12", {kNone, 150.0, 75.8, 51.0, 16.5, 0.4, 0.8, 7.2, 3.4}},
    {"FAIRY", "C-BVH", {kNone, 58.5, 33.5, 23.6, 6.6, 1.0, 1.9, 5.9, 5.3}},
    {"FAIRY", "GP-BVH K_R=2^6", {kNone, 68.9, 46.9, 29.5, 11.6, 0.7, 1.0, 3.4, 3.6}},
    {"FAIRY", "GP-BVH K_R=2^12", {kNone, 80.7, 44.3, 27.8, 11.0, 0.7, 1.0, 3.3, 3.5}},
    {"CONFERENCE", "C-BVH", {kNone, 86.2, 51.3, 35.1, 10.8, 0.6, 1.9, 6.5, 5.8}},
    {"CONFERENCE", "GP-BVH K_R=2^6", {kNone, 88.0, 57.9, 40.8, 11.4, 0.6, 1.8, 4.8, 5.5}},
    {"CONFERENCE", "GP-BVH K_R=2^12", {kNone, 85.2, 54.8, 40.8, 9.3, 0.6, 1.9, 4.6, 5.3}},
    {"VENICE", "C-BVH", {kNone, 95.0, 38.3, 29.7, 5.7, 0.8, 1.7, 1.9, 3.3}},
    {"VENICE", "GP-BVH K_R=2^6", {kNone, 108.8, 61.8, 51.1, 7.1, 0.5, 1.0, 1.9, 2.8}},
    {"SODA HALL", "C-BVH", {kNone, 166.0, 43.1, 36.5, 4.4, 0.8, 2.0, 6.6, 5.3}},
    {"SODA HALL", "GP-BVH K_R=2^6", {kNone, 167.5, 56.8, 46.7, 6.7, 0.5, 1.5, 4.4, 4.1}},
};

constexpr PopovFullRow kGeneric[] = {
    {"BUNNY", "C-BVH", {1.0, 66.6, 32.6, 24.7, 5.2, 0.7, 4.4, 13.0, 11.0}},
    {"BUNNY", "G-BVH", {3.1, 67.2, 31.6, 26.0, 3.7, 0.8, 4.1, 7.3, 9.3}},
    {"BUNNY", "GK-BVH", {3.1, 69.0, 32.3, 26.4, 3.9, 0.8, 4.0, 7.5, 9.3}},
    {"BUNNY", "KD-BVH", {6.6, 95.3, 43.7, 39.2, 3.0, 0.7, 3.0, 6.0, 7.0}},
    {"SPONZA", "C-BVH", {1.0, 142.6, 68.3, 46.7, 14.4, 0.4, 1.4, 8.1, 4.8}},
    {"SPONZA", "G-BVH", {2.6, 121.2, 43.2, 32.8, 6.9, 0.8, 2.0, 7.6, 5.9}},
    {"SPONZA", "GK-BVH", {2.8, 119.3, 43.0, 33.5, 6.3, 0.8, 2.0, 7.4, 5.8}},
    {"SPONZA", "KD-BVH", {8.0, 120.7, 43.1, 38.0, 3.4, 0.8, 1.8, 7.3, 5.2}},
    {"FAIRY", "C-BVH", {2.5, 58.5, 34.0, 23.6, 6.9, 1.0, 1.9, 5.9, 5.1}},
    {"FAIRY", "G-BVH", {12.2, 69.9, 36.4, 25.1, 7.5, 1.0, 1.9, 3.8, 5.1}},
    {"FAIRY", "GK-BVH", {11.6, 70.0, 36.3, 25.2, 7.4, 1.0, 1.9, 3.7, 5.1}},
    {"FAIRY", "KD-BVH", {15.4, 73.2, 37.6, 30.8, 4.5, 0.9, 1.7, 3.5, 4.3}},
    {"CONFERENCE", "C-BVH", {4.1, 86.2, 51.3, 35.1, 10.8, 0.6, 1.9, 6.5, 5.8}},
    {"CONFERENCE", "G-BVH", {4.4, 74.5, 36.2, 29.9, 4.2, 1.0, 2.1, 4.6, 5.8}},
    {"CONFERENCE", "GK-BVH", {4.2, 74.0, 37.2, 30.9, 4.2, 1.0, 2.1, 4.2, 5.7}},
    {"CONFERENCE", "KD-BVH", {30.0, 77.0, 39.1, 33.1, 4.0, 0.9, 2.0, 5.8, 5.6}},
    {"VENICE", "C-BVH", {17.7, 95.0, 38.3, 29.7, 5.7, 0.8, 1.7, 2.0, 3.3}},
    {"VENICE", "G-BVH", {86.7, 84.0, 29.2, 25.0, 2.8, 1.1, 2.1, 1.8, 3.7}},
    {"VENICE", "GK-BVH", {66.8, 86.7, 29.6, 25.4, 2.8, 1.2, 2.2, 1.9, 3.9}},
    {"VENICE", "KD-BVH", {141.0, 102.7, 35.5, 32.3, 2.1, 1.0, 1.9, 1.9, 3.4}},
    {"SODA HALL", "C-BVH", {32.4, 166.0, 43.1, 36.5, 4.4, 0.8, 2.0, 6.6, 5.3}},
    {"SODA HALL", "G-BVH", {152.0, 121.3, 23.6, 19.5, 2.7, 1.2, 3.2, 10.8, 8.7}},
    {"SODA HALL", "GK-BVH", {80.0, 126.2, 24.6, 20.1, 3.0, 1.2, 3.1, 10.7, 8.7}},
    {"SODA HALL", "KD-BVH", {252.0, 136.0, 29.3, 27.6, 1.1, 1.0, 2.8, 11.0, 7.7}},
};

constexpr PopovPresplitRow kPresplit[] = {
    {false, "C-BVH", 1.0, 142, 85, 0.60},
    {false, "EVH-BVH t=14", 1.0, 142, 85, 0.60},
    {false, "EVH-BVH t=16", 1.0, 142, 85, 0.60},
    {false, "ESC-BVH 80", 1.1, 185, 103, 0.50},
    {false, "ESC-BVH 200", 1.1, 167, 96, 0.55},
    {false, "G-BVH", 2.6, 121, 63, 0.95},
    {false, "SS-BVH growth 2.5", 2.8, 119, 63, 0.96},
    {true, "C-BVH", 1.0, 144, 396, 0.11},
    {true, "EVH-BVH t=14", 1.3, 148, 190, 0.25},
    {true, "EVH-BVH t=16", 1.6, 154, 170, 0.28},
    {true, "ESC-BVH 80", 1.3, 155, 179, 0.29},
    {true, "ESC-BVH 200", 1.2, 147, 196, 0.26},
    {true, "G-BVH", 11.4, 86, 100, 0.59},
    {true, "SS-BVH growth 1.5", 1.5, 134, 199, 0.24},
    {true, "SS-BVH growth 2.5", 2.6, 120, 175, 0.27},
    {true, "SS-BVH growth 4", 4.3, 101, 134, 0.36},
    {true, "SS-BVH growth 8", 7.7, 89, 105, 0.54},
};

}  // namespace

std::span<const PopovFullRow> popov_geometric_rows() {
  return kGeometric;
}

std::span<const PopovFullRow> popov_generic_rows() {
  return kGeneric;
}

const PopovPresplitRow* popov_presplit_row(bool turned, std::string_view type) {
  for (const PopovPresplitRow& row : kPresplit)
    if (row.turned == turned && type == row.type) return &row;
  return nullptr;
}

}  // namespace boxwood::program::reproduce
