"""numba's compiler with less around it: what steps and their helpers do not need is left out.

A third of numba's time goes into passes for closures, arrays and literals, of which there are none here; another third
into making machine code of helpers that is never run, as each is compiled into the steps that call it; then passes over
declarations, checks of LLVM code, and helpers linked into helpers. NOTE: these are numba's inner parts, which may
change from one version to the next: ``compiling`` goes on without them where they fail, and says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from types import SimpleNamespace
from typing import Any

import llvmlite.binding as llvm
from numba.core import typed_passes, untyped_passes
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompilerBase
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, _pass_registry, register_pass
from numba.core.environment import lookup_environment
from numba.core.errors import NumbaError
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys
from numba.core.sigutils import normalize_signature

from opsim.engine.fast_engine.machine.code_cache import Code, say


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


ENVIRONMENT = "_ZN08NumbaEnv"
"""How the names of pointers to Python's objects begin that compiled code may use; steps use none."""
_Dispatcher: Any = CPUDispatcher

PASSES: tuple[Any, ...] = (
    *(untyped_passes.TranslateByteCode, untyped_passes.FixupArgs, untyped_passes.IRProcessing),
    *(untyped_passes.GenericRewrites, untyped_passes.ReconstructSSA),
    *(typed_passes.NopythonTypeInference, typed_passes.PreLowerStripPhis),
    *(typed_passes.NoPythonSupportedFeatureValidation, typed_passes.IRLegalization),
)
"""Before the lowering. NOTE: GenericRewrites is what makes ``x ** 2`` a product, as in all that numba compiles."""


@register_pass(mutates_CFG=True, analysis_only=False)
class StepLowering(typed_passes.NativeLowering):
    """To machine code, of which an object file can be kept."""

    _name = "step_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = StepLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class HelperLowering(typed_passes.NativeLowering):
    """To LLVM code, and no further."""

    _name = "helper_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = HelperLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


class Passes(PassManager):
    """Run one after the other. NOTE: numba's own way writes down what each is given, for those who listen: nobody."""

    def run(self, state: Any) -> None:
        for kind, _ in self.passes:
            one = _pass_registry.get(kind).pass_inst
            one.analysis = self._analysis
            for part in (one.run_initialization, one.run_pass, one.run_finalizer):
                part(state)


def _passes(name: str, lowering: Any) -> list[PassManager]:
    manager = Passes(name)
    for one in (*PASSES, lowering, typed_passes.NoPythonBackend):
        manager.add_pass(one)
    manager.finalize()
    return [manager]


HELPER_PASSES, STEP_PASSES = _passes("helper", HelperLowering), _passes("step", StepLowering)


class HelperCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return HELPER_PASSES


class StepCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return STEP_PASSES


class Helper(_Dispatcher):
    """A function that is compiled into others, without numba's timers, which would be told of each by all around it."""

    @global_compiler_lock
    def compile(self, sig: Any) -> Any:
        args, answer = normalize_signature(sig)
        found = self.overloads.get(tuple(args))
        if found is None:
            if not self._can_compile:
                raise RuntimeError("compilation disabled")
            with self._compiling_counter:
                found = self._made(args, answer)
                self.add_overload(found)
        return found.entry_point

    def _made(self, args: Any, answer: Any) -> Any:
        """With all passes, where the few are not enough."""
        try:
            return self._compiler._compile_core(args, answer)
        except (NumbaError, NotImplementedError) as error:
            few, self._compiler.pipeline_class = self._compiler.pipeline_class, Compiler
            try:
                made = self._compiler._compile_core(args, answer)
            finally:
                self._compiler.pipeline_class = few
            say(self.py_func.__qualname__, "compiled by all of numba's passes, which takes longer", error)
            return made


def options(**more: bool) -> dict[str, Any]:
    """As ``numba.njit`` gives them to a function that Python does not call."""
    said = {"nopython": True, "nogil": True, "boundscheck": None}
    return {**said, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **more}


def helper(**more: bool) -> Callable[[Callable], Any]:
    """What makes of a function one that is compiled into each that calls it."""

    def made(function: Callable) -> Any:
        return Helper(py_func=function, locals={}, targetoptions=options(**more), pipeline_class=HelperCompiler)

    return made


def compiled_step(signature: Any, function: Callable) -> Code:
    """The machine code of a function compiled for one signature.

    Raises LookupError where it refers to something of this process: such code cannot be kept.
    """
    made = Helper(py_func=function, locals={}, targetoptions=options(), pipeline_class=StepCompiler)
    made.compile(signature)
    return _code(made.overloads[tuple(signature.args)])


def _code(result: Any) -> Code:
    """Machine code that refers to nothing of this process but functions known by their names."""
    library, name = result.library, result.fndesc.llvm_func_name
    module = library._final_module
    outside = [one.name for one in (*module.functions, *module.global_variables) if one.is_declaration]
    environments = [one.name for one in module.global_variables if one.name.startswith(ENVIRONMENT)]
    known = [found for name in environments if (found := lookup_environment(name)) is not None]
    if library.has_dynamic_globals or any(one.consts for one in known):
        raise LookupError(f"{name} refers to objects of Python")
    return Code(name, tuple(one for one in outside if not one.startswith("llvm.")), library.machine_code)
