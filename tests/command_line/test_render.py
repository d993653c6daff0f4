"""boxwood render: pictures."""

import struct
import unittest
import zlib

from support import CommandLineTest

SCENE = "scene:atrium,triangles=3000"


def read_png(path):
    """Width, height and the unfiltered-size image bytes of an 8-bit RGB PNG."""
    raw = path.read_bytes()
    assert raw[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, colour = struct.unpack(">IIBB", raw[16:26])
    assert (depth, colour) == (8, 2), (depth, colour)
    data, at = b"", 8
    while at < len(raw):
        (length,) = struct.unpack(">I", raw[at:at + 4])
        if raw[at + 4:at + 8] == b"IDAT":
            data += raw[at + 8:at + 8 + length]
        at += 12 + length
    pixels = zlib.decompress(data)
    assert len(pixels) == height * (1 + 3 * width)
    return width, height, pixels


class Render(CommandLineTest):
    def test_every_shade(self):
        pictures = set()
        for shade in ("normals", "ao", "depth", "nodes", "primitives", "ids", "clusters", "children"):
            with self.subTest(shade):
                path = self.folder / f"{shade}.png"
                report = self.report("render", SCENE, "-o", path, "--size", "200x120", "--shade", shade)
                self.assert_environment(report, "render")
                self.assertEqual(report["options"]["shade"], shade)
                self.assertEqual(report["primary_rays"], 200 * 120)
                width, height, pixels = read_png(path)
                self.assertEqual((width, height), (200, 120))
                self.assertGreater(len(set(pixels)), 20, "the picture shows something")
                pictures.add(pixels)
        self.assertEqual(len(pictures), 8)

    def test_children_of_a_node(self):
        pictures = set()
        for node in ([], ["--node", "0"], ["--node", "1"], ["--node", "2"]):
            report = self.report("render", SCENE, "-o", "p.png", "--size", "64x64", "--shade", "children", *node)
            self.assertEqual(report["options"]["node"], int(node[1]) if node else 0)
            pictures.add((self.folder / "p.png").read_bytes())
        self.assertEqual(len(pictures), 3, "the default is node 0")
        for arguments, message in ((["--shade", "children", "--node", "99999999"], "there is no node 99999999"),
                                   (["--shade", "ids", "--node", "1"], "--node is for --shade children only"),
                                   (["--shade", "blue"], "primitives, ids, subdivided, clusters, children")):
            self.refused("render", SCENE, "-o", "p.png", *arguments, says=[message])

    def test_the_printed_camera_repeats_the_picture(self):
        report = self.report("render", self.cube, "-o", "a.png", "--size", "40x30")
        self.report("render", self.cube, "-o", "b.png", "--size", "40x30", "--camera", report["camera"])
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "b.png").read_bytes())
        self.report("render", self.cube, "-o", "c.png", "--size", "40x30", "--camera", "fov=10")
        self.assertNotEqual((self.folder / "a.png").read_bytes(), (self.folder / "c.png").read_bytes())

    def test_builder_layout_and_threads_do_not_change_the_picture(self):
        pictures = set()
        for options in ([], ["-b", "lbvh"], ["-l", "linear"], ["-l", "wide4", "--threads", 3]):
            self.run_program("render", SCENE, "-o", "p.png", "--size", "64x64", *options)
            pictures.add((self.folder / "p.png").read_bytes())
        self.assertEqual(len(pictures), 1)

    def test_one_pixel(self):
        self.run_program("render", self.cube, "-o", "p.png", "--size", "1x1", "--shade", "nodes")
        self.assertEqual(read_png(self.folder / "p.png")[:2], (1, 1))

    def test_bad_options(self):
        self.refused("render", self.cube, "-o", "p.png", "--shade", "gold", says=["gold", "normals"])
        self.refused("render", self.cube, "-o", "p.png", "--size", "20000x1", code=2, says="20000")
        self.refused("render", self.cube, "-o", "p.png", "--size", "5", code=2, says="5")
        self.refused("render", self.cube, "-o", "p.png", "--camera", "eye=1:1:1,look_at=1:1:1", says="1")
        self.refused("render", self.cube, "-o", self.folder, says=str(self.folder))
        self.refused("render", self.cube, "-o", self.folder / "no" / "p.png", says="no")
        self.assertFalse((self.folder / "p.png").exists())


if __name__ == "__main__":
    unittest.main()
