"""LLVM code of helpers and steps, as numba's libraries of code, without what numba does again and again.

Of its time a third went into passes over declarations, checks of LLVM code, helpers linked into helpers and all of them
into steps, and loops unrolled.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from types import SimpleNamespace
from typing import Any

import llvmlite.binding as llvm
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary
from numba.core.runtime import rtsys


class _Library(JITCodeLibrary):
    """LLVM code of one function, of which numba makes no machine code."""

    @property
    def codegen(self) -> Any:
        """For ``get_executable``, which would look for the environment of a function in the machine code."""
        return SimpleNamespace(set_env=lambda _name, _environment: None)

    def get_pointer_to_function(self, name: str) -> int:
        """There is none."""
        self._ensure_finalized()
        return 0

    def add_linking_library(self, library: Any) -> None:
        """NOTE: but for numba's own runtime, which counts references to arrays, and of which nothing is used."""
        if library is not rtsys.library:
            super().add_linking_library(library)

    def add_ir_module(self, ir_module: Any) -> None:
        """NOTE: it is looked at once, when it is whole: numba does so for each part."""
        module = llvm.parse_assembly(normalize_ir_text(str(ir_module)))
        self._optimize_functions(module)
        self._final_module.link_in(module)


class HelperLibrary(_Library):
    """Only ever linked into steps. NOTE: not into the helpers that call it, each step links all that it needs once."""

    def _optimize_functions(self, module: Any) -> None:
        """Once for all steps. NOTE: numba makes a row of passes for each function, and runs it on declarations too."""
        module.data_layout = self._codegen._data_layout
        builder = _pass_builder(self._codegen)
        passes = builder.getFunctionPassManager()
        for function in module.functions:
            if not function.is_declaration:
                passes.run(function, builder)

    def finalize(self) -> None:
        """Nothing is linked into it."""
        self._raise_if_finalized()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """For what numba compiles by all of its passes: with all that it needs in turn."""
        if self._shared_module is None:
            whole = self._final_module.clone()
            for code in _all_linked(self):
                whole.link_in(code, preserve=True)
            for one in whole.functions:
                if not one.is_declaration:
                    one.linkage = llvm.Linkage.linkonce_odr
            self._shared_module = whole
        return self._shared_module


class StepLibrary(_Library):
    """Of a step and all helpers compiled into it."""

    machine_code: bytes

    def _optimize_functions(self, module: Any) -> None:
        """Left to the passes over all of it."""
        module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        """Optimized once, by LLVM's second level: numba's three rounds and its third level took longer and ran no
        faster.

        NOTE: helpers become the step's own. Names of numba's count functions as a process meets them, so that helpers
        of two processes could share one, and LLVM links all of a name to the first.
        """
        self._raise_if_finalized()
        module = self._final_module
        own = {one.name for one in module.functions if not one.is_declaration}
        for code in _all_linked(self):
            module.link_in(code, preserve=True)
        for one in module.functions:
            if not one.is_declaration and one.name not in own:
                one.linkage = llvm.Linkage.internal
        module.verify()
        builder = _pass_builder(self._codegen)
        builder.getModulePassManager().run(module, builder)
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self.machine_code = _machine(self._codegen).emit_object(module)
        self._finalized = True


def _all_linked(library: Any) -> Iterator[Any]:
    """The code of all that is to be linked into a step: helpers, each once, then what numba has made by itself.

    NOTE: in this order, as the code of the others is dropped where nobody calls it yet.
    """
    todo, seen, others = list(library._linking_libraries), set[Any](), dict[Any, None]()
    while todo:
        one = todo.pop()
        if isinstance(one, HelperLibrary) and one not in seen:
            seen.add(one)
            todo += one._linking_libraries
            yield one._final_module
        elif not isinstance(one, HelperLibrary):
            others[one] = None
    yield from (one._get_module_for_linking() for one in others)


def _pass_builder(codegen: Any) -> Any:
    """LLVM's second level. NOTE: unrolled loops over a handful of jobs or stations are only longer."""
    options = llvm.create_pipeline_tuning_options(speed_level=2)
    options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
    return llvm.create_pass_builder(codegen._tm, options)


@cache
def _machine(codegen: Any) -> Any:
    """Makes machine code as numba does for this processor, by LLVM's second level too, which ran as fast."""
    options = {"opt": 2}
    codegen._customize_tm_options(options)
    return llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(**options)
