"""The pose graph by the chapter's second example, by covariances from a dense inverse, and with a false loop."""

import numpy as np
import pytest
import rustslam2d as rs
from conftest import skip

EYE = np.eye(3)


@pytest.fixture
def chain():
    """Two edges of odometry of 1 m, and a loop of 2.6 m."""
    graph = rs.PoseGraph()
    a = graph.add_node((0, 0, 0), fixed=True)
    b, c = graph.add_node((1, 0, 0)), graph.add_node((2, 0, 0))
    assert (a, b, c, len(graph)) == (0, 1, 2, 3)
    assert [graph.add_edge(*edge, EYE) for edge in [(a, b, (1, 0, 0)), (b, c, (1, 0, 0)), (a, c, (2.6, 0, 0))]] == [0, 1, 2]
    return graph


@pytest.mark.parametrize("method", ["gn", "lm"])
def test_each_edge_takes_a_third_of_the_contradiction(chain, method):
    assert chain.chi2 == pytest.approx(0.36, abs=1e-12)
    report = chain.optimize(method=method)
    assert (report.chi2_initial, report.chi2) == (pytest.approx(0.36), pytest.approx(0.12))
    assert report.converged and report.cost == report.chi2 == chain.chi2
    # 1e-8: the solver adds 1e-9 to the diagonal.
    assert np.allclose(chain.poses, [(0, 0, 0), (1.2, 0, 0), (2.4, 0, 0)], atol=1e-8)
    assert np.allclose(chain.edge_chi2, 0.04, atol=1e-8)


def test_covariances_are_those_of_the_normal_equations(chain):
    chain.optimize()
    marginals = chain.marginals()
    assert marginals.shape == (3, 3, 3) and not marginals[0].any()
    # Along x the two free nodes have H = [[2, −1], [−1, 2]].
    along = np.linalg.inv([[2, -1], [-1, 2]])
    assert np.allclose(marginals[1:, 0, 0], np.diag(along), rtol=1e-6)
    relative = chain.relative_covariance(1, 2)
    assert relative[0, 0] == pytest.approx(along[0, 0] + along[1, 1] - 2 * along[0, 1], rel=1e-6)
    assert np.allclose(relative, relative.T)


def test_a_kernel_lets_go_of_a_false_loop_and_the_inliers_leave_it_out(driven):
    slam, _ = driven
    graph = slam.graph
    graph.optimize()
    right = graph.poses
    # The last keyframe stands at the first, so this puts it 3 m off.
    graph.add_edge(0, len(graph) - 1, (3.0, 0.0, 0.0), 100 * EYE)
    inliers = graph.inlier_edges()
    assert inliers.dtype == bool and not inliers[-1] and inliers[:-1].sum() >= len(graph) - 1
    plain = rs.PoseGraph.from_g2o(graph.to_g2o())
    plain.optimize()
    graph.optimize(dcs=1.0)
    shift = [np.abs(poses - right)[:, :2].max() for poses in (plain.poses, graph.poses)]
    assert shift[0] > 0.5 and shift[1] < 0.2 * shift[0]
    kept = plain.with_edges(inliers)
    assert len(kept.edges) == inliers.sum() and len(kept) == len(plain)


def test_a_file_of_g2o_reads_back_to_the_same_bits(chain, tmp_path):
    chain.poses = chain.poses + np.random.default_rng(1).normal(size=(3, 3))
    chain.add_edge(0, 2, (0.1, 0.2, 0.3), [[3, 1, 0], [1, 4, 0.5], [0, 0.5, 5]])
    path = tmp_path / "graph.g2o"
    chain.write_g2o(path)
    read = rs.PoseGraph.read_g2o(str(path))
    for mine, its in zip(
        (chain.poses, chain.edges, chain.measurements, chain.informations, chain.ids, chain.edge_chi2),
        (read.poses, read.edges, read.measurements, read.informations, read.ids, read.edge_chi2),
    ):
        assert np.array_equal(mine, its)
    assert read.to_g2o() == chain.to_g2o() == path.read_text()


def test_ids_of_a_file_stay_and_new_nodes_come_after_them():
    graph = rs.PoseGraph.from_g2o("VERTEX_SE2 7 0 0 0\nVERTEX_SE2 3 1 0 0\nEDGE_SE2 7 3 1 0 0 1 0 0 1 0 1\n")
    assert graph.add_node((2, 0, 0)) == 2
    assert graph.ids.tolist() == [7, 3, 8] and graph.edges.tolist() == [[0, 1]]


@pytest.mark.parametrize(
    ("edge", "error", "said"),
    [
        ((0, 9, (1, 0, 0), EYE), IndexError, "there is no node 9: the graph has 3"),
        ((-1, 0, (1, 0, 0), EYE), IndexError, "there is no node -1: the graph has 3"),
        ((1, 1, (1, 0, 0), EYE), rs.GraphError, "an edge from node 1 to itself"),
        ((0, 1, (1, 0, 0), -EYE), rs.GraphError, "the information matrix is not positive semi-definite"),
        ((0, 1, (1, 0, 0), np.triu(np.ones((3, 3)))), rs.ArrayError, "information is not symmetric"),
        ((0, 1, (1, 0), EYE), rs.ArrayError, "measurement has to have the shape (3,), (3, 3) or (4, 4), not (2,)"),
        ((0, 1, (1, 0, 0), EYE[:2]), rs.ArrayError, "information has to have the shape (3, 3), not (2, 3)"),
    ],
)
def test_a_wrong_edge_is_rejected_in_a_sentence(chain, edge, error, said):
    with pytest.raises(error) as rejected:
        chain.add_edge(*edge)
    assert str(rejected.value) == said
    assert len(chain.edges) == 3


def test_what_cannot_be_solved_is_said_and_moves_nothing(chain):
    chain.add_node((5, 5, 0))
    before = chain.poses
    for reject in (chain.optimize, chain.marginals, chain.inlier_edges, lambda: chain.relative_covariance(0, 1)):
        with pytest.raises(rs.OptimizeError) as rejected:
            reject()
        assert str(rejected.value) == "no chain of edges ties node 3 to a fixed node; give one node fixed=True"
    assert np.array_equal(chain.poses, before)
    far = rs.PoseGraph()
    far.add_node((0, 0, 0), fixed=True)
    far.add_node((1e200, 0, 0))
    far.add_edge(0, 1, (-1e200, 0, 0), EYE)
    with pytest.raises(rs.OptimizeError, match="the cost or the step is not finite"):
        far.optimize(start="given")
    with pytest.raises(rs.ChoiceError, match="start has to be one of auto, given, spanning-tree, chordal"):
        chain.optimize(start="here")
    with pytest.raises(rs.ChoiceError, match="huber and dcs exclude each other"):
        chain.optimize(huber=1.0, dcs=1.0)
    with pytest.raises(rs.ArrayError, match=r"poses has to have the shape \(4, 3\), not \(3, 3\)"):
        chain.poses = np.zeros((3, 3))
    with pytest.raises(rs.ArrayError, match=r"keep has to have the shape \(3,\), not \(1,\)"):
        chain.with_edges([True])


def test_a_malformed_file_is_named_with_its_line(tmp_path):
    path = tmp_path / "broken.g2o"
    path.write_text("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0\n")
    with pytest.raises(rs.GraphError) as rejected:
        rs.PoseGraph.read_g2o(path)
    assert str(rejected.value) == f"{path}: line 2: EDGE_SE2 needs 11 numbers, found 10"
    with pytest.raises(FileNotFoundError) as absent:
        rs.PoseGraph.read_g2o(tmp_path / "absent.g2o")
    assert absent.value.filename == str(tmp_path / "absent.g2o")


def test_gtsam_reads_every_pose_and_every_edge(chain, tmp_path):
    try:
        import gtsam
    except ImportError:
        skip("files of g2o, read by GTSAM", "gtsam has no wheel for this Python")
    path = tmp_path / "graph.g2o"
    chain.write_g2o(path)
    text = path.read_text()
    factors, poses = gtsam.readG2o(str(path), False)
    assert (poses.size(), factors.size()) == (text.count("VERTEX_SE2"), text.count("EDGE_SE2"))
    assert "FIX" in text


def test_the_gate_is_the_chapters():
    assert rs.chi2_gate() == pytest.approx(7.815, abs=5e-4)
    with pytest.raises(rs.ChoiceError, match="quantile has to be within"):
        rs.chi2_gate(1.0)


def test_what_a_graph_leaves_out_is_a_warning(tmp_path):
    text = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nVERTEX_XY 2 1 1\n"
    (tmp_path / "x.g2o").write_text(text)
    for read in (lambda: rs.PoseGraph.from_g2o(text), lambda: rs.PoseGraph.read_g2o(tmp_path / "x.g2o")):
        with pytest.warns(UserWarning, match="line 4: VERTEX_XY: landmarks are not optimized") as said:
            assert len(read()) == 2
        assert len(said) == 1 and said[0].filename == __file__
