"""Forty faults and more over the whole house, and the test that sees each: a table.

Subject, function, its words, wrong words, tests that fail then. Modules and test files are found by search, so that
both may move; ``tests/test_faults.py`` plants one after the other in a copy of the project.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """subject : a word of the table's first column; function : in which ``old`` stands once, and ``new`` instead"""

    subject: str
    function: str
    old: str
    new: str
    caught_by: tuple[str, ...]

    @property
    def name(self) -> str:
        return f"{self.subject}: {self.function}: {self.new}"


FAULTS = (
    Fault("floor", "longest_queue", "(-n_waiting,", "(n_waiting,", ("test_a_rule_looks_at_one_thing_first",)),
    Fault("floor", "edd", "(due_s, since_s", "(-due_s, since_s", ("test_the_rule_says_which_waiting_job_is_next",)),
    Fault(
        "floor",
        "victim_key",
        "(priority, -since_s",
        "(priority, since_s",
        ("test_of_two_on_servers_the_lower_then_the_later_gives_way",),
    ),
    Fault(
        "floor",
        "batch_begins",
        "n_waiting >= size",
        "n_waiting > size",
        ("test_a_batch_begins_when_it_is_full_and_its_task_is_done_once",),
    ),
    Fault(
        "floor",
        "stock_wanted",
        "level + n_waited_for",
        "level",
        ("test_a_base_stock_makes_a_piece_whenever_stock_and_what_is_on_the_way_are_below_its_level",),
    ),
    Fault(
        "floor",
        "turned_down",
        "finds if bad else false_alarms",
        "false_alarms if bad else finds",
        ("test_a_perfect_inspection_scraps_just_the_jobs_that_chance_left_a_defect_in",),
    ),
    Fault(
        "floor",
        "least_time",
        "(at_post_s, turns_away",
        "(-at_post_s, turns_away",
        ("test_by_the_least_time_so_far_the_post_goes_to_who_was_there_for_the_shortest_time",),
    ),
    Fault(
        "floor",
        "reworked",
        "n_reworks < most",
        "n_reworks <= most",
        ("test_rework_elsewhere_comes_back_to_be_inspected_again",),
    ),
    Fault("figures", "gini", "have.size - 1", "have.size", ("test_known_answers",)),
    Fault(
        "figures",
        "_lateness_s",
        "created_s(log, job) + ",
        "0.0 * created_s(log, job) + ",
        ("test_a_job_that_is_done_on_its_due_date_is_not_late_by_a_tick",),
    ),
    Fault(
        "figures",
        "times_in_system",
        'log["end_s"][done] - created_s',
        'log["end_s"][done] - 0.5 * created_s',
        ("test_lead_times_and_their_quantiles_are_those_of_the_hand",),
    ),
    Fault(
        "figures",
        "quantile",
        "np.argmax(reached, axis=1)",
        "np.argmax(reached, axis=1) + 1",
        ("test_the_quantile_is_the_score_at_or_below_which_that_share_of_the_time_is",),
    ),
    Fault("figures", "elapsed_s", "return", "return 2 *", ("test_elapsed_time_stands_still_outside_of_the_spans",)),
    Fault("study", "t_interval", "(1 + confidence) / 2", "confidence", ("test_the_textbook_interval",)),
    Fault(
        "study",
        "quantile_interval",
        "below <= miss",
        "below <= 2 * miss",
        ("test_order_statistics_that_bound_a_median_are_those_of_the_tables",),
    ),
    Fault("study", "holm", "np.arange(order.size, 0, -1)", "order.size", ("test_holm_is_the_textbook_procedure",)),
    Fault(
        "study",
        "lag_one",
        "2 * whole - (first + second) / 2",
        "whole",
        ("test_the_jackknife_takes_the_bias_of_short_series_away",),
    ),
    Fault(
        "study",
        "von_neumann",
        "(n - 2) / (n**2 - 1)",
        "(n - 2) / (n - 1)",
        ("test_von_neumanns_ratio_by_hand_and_its_size",),
    ),
    Fault(
        "study",
        "ocba_allocation",
        "np.square(spread / gap)",
        "spread / gap",
        ("test_the_allocation_is_that_of_the_reference",),
    ),
    Fault(
        "study", "dominates", "(first > second).any", "(first >= second).any", ("test_the_front_is_what_nothing_beats",)
    ),
    Fault("study", "growth", "(n - 1) / 2", "n / 2", ("test_a_straight_line_grows_by_what_it_grows",)),
    Fault(
        "study",
        "_begun",
        "2.0 * kn_eta(freedom, self._error) * freedom",
        "2.0 * kn_eta(freedom, self._error)",
        ("test_the_first_decision_of_two_systems_is_the_one_done_by_hand",),
    ),
    Fault(
        "emulator",
        "log_coordinates",
        "np.arctan2(sine, cosine)",
        "sine",
        ("test_log_coordinates_are_those_of_the_log",),
    ),
    Fault(
        "emulator",
        "clr",
        "ratio - ratio.mean(-1, keepdims=True)",
        "ratio",
        ("test_clr_sums_to_zero_and_tells_the_slopes_of_a_smooth_warp",),
    ),
    Fault("emulator", "anova", "max(n - w, 1)", "n", ("test_icc_of_shrout_and_fleiss_is_found",)),
    Fault(
        "emulator", "moments_s", "log_s + square / 2", "log_s", ("test_the_mean_of_a_lognormal_margin_is_the_formula",)
    ),
    Fault(
        "emulator",
        "_column",
        "(1.0 - self.zero_share[j])",
        "1.0",
        ("test_the_share_of_no_pause_and_the_dwells_are_recovered",),
    ),
    Fault(
        "emulator",
        "evaluate",
        "(right - left)",
        "0.9 * (right - left)",
        ("test_the_square_clock_halves_the_way_at_a_quarter",),
    ),
    Fault(
        "emulator",
        "mark_share",
        "dwell_s @ self.dwells.mark_share.T",
        "0.5 * dwell_s @ self.dwells.mark_share.T",
        ("test_the_share_of_no_pause_and_the_dwells_are_recovered",),
    ),
    Fault(
        "emulator",
        "decode",
        "exponent[:, None].astype(int)",
        "exponent[:, None].astype(int) + 1",
        ("test_rounding_to_the_grid_twice_is_rounding_once",),
    ),
    Fault("emulator", "part_at", "own_s, 0.0", "own_s, 0.1", ("test_postures_and_speeds_are_continuous_at_a_join",)),
    Fault(
        "ergonomics",
        "recommended_weight_limit",
        "found.without_frequency * found.fm",
        "found.without_frequency",
        ("test_a_lift_by_hand",),
    ),
    Fault("ergonomics", "composite_index", "before += often", "before += 0.5 * often", ("test_a_composite_by_hand",)),
    Fault("ergonomics", "wrist_score", "abs(flexion) <= 15", "abs(flexion) < 15", ("test_edges_are_as_in_the_paper",)),
    Fault(
        "ergonomics", "reba_load", "load_kg >= 5", "load_kg > 5", ("test_rebas_load_begins_at_5_kg_and_owas_after_10",)
    ),
    Fault("ergonomics", "holding_time_min", "0.6 / f**2", "0.6 / f", ("test_rohmerts_holding_times_by_hand",)),
    Fault("ergonomics", "owas_load", "load_kg > 20", "load_kg > 25", ("test_what_is_not_said_is_all_that_it_may_be",)),
    Fault(
        "readers", "floats_of", ".astype(float) / 4", ".astype(float)", ("test_the_bytes_of_each_processor_are_read",)
    ),
    Fault(
        "readers",
        "canonical_name",
        '{"l": "left", "r": "right"}',
        '{"l": "right", "r": "left"}',
        ("test_aliases_lead_to_the_canonical_name",),
    ),
    Fault("readers", "without_missing_frames", "np.nan", "0.0", ("test_frames_left_out_become_gaps",)),
    Fault(
        "figures",
        "_takt_s",
        "1 / sum(1 / one for one in every_s)",
        "sum(every_s) / len(every_s)",
        ("test_two_sources_together_are_as_quick_as_both",),
    ),
    Fault(
        "study",
        "first_weight",
        "1.0 + float(np.sqrt",
        "1.0 - float(np.sqrt",
        ("test_the_first_weight_solves_the_equation_and_is_no_less_than_the_first_stages_share",),
    ),
    Fault(
        "emulator",
        "drawn",
        "alike * MIRRORED * unit",
        "alike * unit",
        ("test_drawn_turns_have_the_spread_and_the_sides_that_were_asked_for",),
    ),
    Fault("emulator", "_normal_scores", "- 0.375) / (n + 0.25)", "- 0.5) / n", ("test_normal_scores_are_bloms",)),
    Fault(
        "emulator", "regression", "column / column[at]", "column", ("test_slopes_are_covariances_over_the_variance",)
    ),
)
